// SPDX-License-Identifier: GPL-3.0-or-later
#include "calls.hpp"

#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

namespace eomgen::python {
namespace {

/// Of the outermost watch of the main thread; inner calls of callbacks share its stop request.
std::mutex active_mutex;
std::stop_source* active = nullptr;
struct sigaction python_handler;
sem_t interrupts;
std::atomic<bool> has_watcher{false};

bool is_main_thread() {
  thread_local const bool main = getpid() == static_cast<pid_t>(syscall(SYS_gettid));
  return main;
}

// Only what POSIX permits in a handler: the stop is requested by the watcher's thread.
void on_interrupt(int signal, siginfo_t* info, void* context) {
  sem_post(&interrupts);
  if ((python_handler.sa_flags & SA_SIGINFO) != 0) return python_handler.sa_sigaction(signal, info, context);
  python_handler.sa_handler(signal);
}

void watch_interrupts() {
  while (true) {
    while (sem_wait(&interrupts) != 0) {
    }
    const std::scoped_lock lock(active_mutex);
    if (active != nullptr) active->request_stop();
  }
}

void start_watcher() {
  if (has_watcher.exchange(true)) return;
  static const bool once = [] {
    // A child process has no watcher.
    pthread_atfork(nullptr, nullptr, [] { has_watcher = false; });
    return sem_init(&interrupts, 0, 0) == 0;
  }();
  if (once) std::thread(watch_interrupts).detach();
}

bool is_given(const py::object& callback) { return callback && !callback.is_none(); }

}  // namespace

InterruptWatch::InterruptWatch() {
  if (!is_main_thread()) return;
  const std::scoped_lock lock(active_mutex);
  if (active != nullptr) {
    stop_ = *active;
    return;
  }
  struct sigaction ours {};
  ours.sa_sigaction = on_interrupt;
  ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGINT, nullptr, &python_handler);
  const bool is_function = (python_handler.sa_flags & SA_SIGINFO) != 0 ||
                           (python_handler.sa_handler != SIG_DFL && python_handler.sa_handler != SIG_IGN);
  if (!is_function) return;
  start_watcher();
  sigaction(SIGINT, &ours, nullptr);
  active = &stop_;
  installed_ = true;
}

InterruptWatch::~InterruptWatch() {
  if (!installed_) return;
  sigaction(SIGINT, &python_handler, nullptr);
  const std::scoped_lock lock(active_mutex);
  active = nullptr;
}

PythonControl::PythonControl(const Callbacks& callbacks) {
  control_.stop = watch_.token();
  if (is_given(callbacks.stage)) {
    control_.on_stage = [this, f = py::handle(callbacks.stage)](const std::string& stage) { call([&] { f(stage); }); };
  }
  if (is_given(callbacks.progress)) {
    control_.on_progress = [this, f = py::handle(callbacks.progress)](double fraction) {
      call([&] {
        if (f(fraction).ptr() != Py_False) return;
        ended_ = true;
        watch_.request_stop();
      });
    };
  }
  if (is_given(callbacks.warning)) {
    control_.on_warning = [this, f = py::handle(callbacks.warning)](const std::string& text) {
      call([&] { f(text); });
    };
  }
}

void PythonControl::rethrow() {
  if (failure_) throw std::move(*failure_);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace eomgen::python
