// Part of eomgen.js (generator/cli/CMakeLists.txt): what Node has and emscripten 3.1.6 does not pass on. The code of the
// program comes from the file beside it, because emscripten takes the fetch of Node for that of a browser.
Module['wasmBinary'] = require('fs').readFileSync(__dirname + '/eomgen.wasm');
Module['preRun'] = [function() {
  for (var name in process.env) ENV[name] = process.env[name];
}];
Module['onRuntimeInitialized'] = function() {
  _umask(process.umask());
};
