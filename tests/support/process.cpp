// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "support/sanitized.hpp"

extern char** environ;

namespace eomgen::test {
namespace {

std::vector<std::string> changed_environment(const ChildCommand& command) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!command.environment.contains(text.substr(0, text.find('=')))) result.push_back(text);
  }
  for (const auto& [name, value] : command.environment) {
    if (value) result.push_back(name + "=" + *value);
  }
  return result;
}

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return ends;
}

/// Reads the available bytes; returns false at the end of the stream.
bool take(int file, std::string& text) {
  std::array<char, 1 << 16> buffer{};
  const ssize_t n = ::read(file, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR;
  text.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

}  // namespace

Child::Child(const ChildCommand& command)
    : limit_(sanitized ? 10 * command.limit : command.limit), start_(std::chrono::steady_clock::now()) {
  const std::array<int, 2> out = make_pipe(), err = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, command.folder.c_str());
  const std::vector<std::string> environment = changed_environment(command);
  const std::vector<char*> arguments = pointers(command.arguments), variables = pointers(environment);
  const int failed = ::posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), variables.data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0];
  err_ = err[0];
  if (failed == 0) return;
  ::close(out_);
  ::close(err_);
  throw std::runtime_error("cannot start " + command.arguments[0] + ": " + std::strerror(failed));
}

Child::~Child() {
  ::close(out_);
  ::close(err_);
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Child::signal(int number) const { ::kill(process_, number); }

void Child::read_until(std::chrono::steady_clock::time_point end, ChildResult& result) {
  std::array<pollfd, 2> files{pollfd{out_, POLLIN, 0}, pollfd{err_, POLLIN, 0}};
  while (files[0].fd >= 0 || files[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      result.in_time = false;
      ::kill(process_, SIGKILL);
      return;
    }
    if (::poll(files.data(), files.size(), static_cast<int>(left.count()) + 1) <= 0) continue;
    if (files[0].revents != 0 && !take(out_, result.out)) files[0].fd = -1;
    if (files[1].revents != 0 && !take(err_, result.err)) files[1].fd = -1;
  }
}

ChildResult Child::finish() {
  ChildResult result;
  const auto length =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(limit_));
  read_until(start_ + length, result);
  int status = 0;
  struct rusage used {};
  while (::wait4(process_, &status, 0, &used) < 0 && errno == EINTR) {
  }
  process_ = -1;
  result.peak_kilobytes = used.ru_maxrss;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  return result;
}

}  // namespace eomgen::test
