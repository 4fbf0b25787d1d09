% The cart and its pendulum with ode45, and with lsode and the Jacobian.
model = cart_pendulum();
options = odeset('RelTol', 1e-10, 'AbsTol', 1e-12);
[t, x] = ode45(@(t, x) model.rhs(t, x), [0, 10], model.x, options);
lsode_options('relative tolerance', 1e-10);
lsode_options('absolute tolerance', 1e-12);
y = lsode({@(x, t) model.rhs(t, x), @(x, t) model.jac(t, x)}, model.x, [0, 10]);
if max(abs(x(end, :) - y(end, :))) > 1e-6, error('ode45 and lsode differ'); end
for i = 1:numel(model.states)
  printf('%s %.12g\n', model.states{i}, x(end, i));
end
