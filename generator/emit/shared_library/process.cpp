// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

extern char** environ;

namespace eomgen::emit {
namespace {

constexpr int poll_interval = 50;  // ms, polling interval for interruptions

/// Whether this program handles Ctrl-C. If so, the child gets its own process group, so that all of it can be
/// terminated.
bool handles_interrupts() {
  struct sigaction now {};
  return ::sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler != SIG_DFL;
}

/// Resets the signals that this program handles or ignores to their defaults.
void set_attributes(posix_spawnattr_t& attributes, bool own_group) {
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           static_cast<short>(POSIX_SPAWN_SETSIGDEF | (own_group ? POSIX_SPAWN_SETPGROUP : 0)));
}

/// Reads the output to its end; false if interrupted.
bool read_all(int pipe, std::string& output, const std::atomic<bool>* interrupt) {
  std::array<char, 4096> buffer{};
  while (true) {
    if (interrupt != nullptr && *interrupt) return false;
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, interrupt == nullptr ? -1 : poll_interval);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t n = ::read(pipe, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    output.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

void end(pid_t child, bool own_group) {
  const pid_t target = own_group ? -child : child;
  ::kill(target, SIGTERM);  // lets compilers remove their temporary files
  for (int k = 0; k < 4; ++k) {
    if (::waitpid(child, nullptr, WNOHANG) != 0) break;
    ::poll(nullptr, 0, poll_interval);
  }
  ::kill(target, SIGKILL);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

bool can_start_programs() { return true; }

ProcessResult run_process(const std::vector<std::string>& arguments, const std::atomic<bool>* interrupt) {
  ProcessResult result;
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return result;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  const bool own_group = interrupt != nullptr && handles_interrupts();
  posix_spawnattr_t attributes;
  set_attributes(attributes, own_group);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(pipe[1]);
  if (failed == 0 && !read_all(pipe[0], result.output, interrupt)) {
    end(child, own_group);
    result.started = result.interrupted = true;
  } else if (failed == 0) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.started = result.status != 127;  // some systems report a missing program this way
  }
  ::close(pipe[0]);
  return result;
}

}  // namespace eomgen::emit
