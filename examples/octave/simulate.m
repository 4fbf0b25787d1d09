% The cart and its pendulum with Octave's ode45 around the generated C.
[x0, p] = cart_pendulum_mex();
options = odeset("RelTol", 1e-10, "AbsTol", 1e-12);
[t, x] = ode45(@(t, x) cart_pendulum_mex(t, x, p), [0, 10], x0, options);
printf("x %.12g\ntheta %.12g\nx_dot %.12g\ntheta_dot %.12g\n", x(end, :));
