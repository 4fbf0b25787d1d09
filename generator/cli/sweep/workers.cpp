// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/workers.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "cli/output.hpp"
#include "error.hpp"

namespace eomgen::cli {
namespace {

class Child {
 public:
  Child(pid_t id, int pipe) : id_(id), pipe_(pipe) {}
  Child(Child&& other) noexcept
      : id_(std::exchange(other.id_, 0)), pipe_(std::exchange(other.pipe_, -1)), text_(std::move(other.text_)) {}
  Child& operator=(Child&&) = delete;
  ~Child() {  // still running after an error or an interruption
    if (id_ <= 0) return;
    close(pipe_);
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }

  int pipe() const { return pipe_; }
  bool open() const { return id_ > 0; }

  /// Reads the available output and passes complete lines to `take`. At its end returns whether the process succeeded.
  template <class Take>
  bool read(Take&& take) {
    char buffer[4096];
    const ssize_t count = ::read(pipe_, buffer, sizeof buffer);
    if (count < 0) return errno == EINTR || errno == EAGAIN;
    if (count == 0) return ended();
    text_.append(buffer, static_cast<std::size_t>(count));
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1))
      take(text_.substr(0, end));
    return true;
  }

 private:
  bool ended() {
    int status = 0;
    close(pipe_);
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  pid_t id_;
  int pipe_;
  std::string text_;
};

bool write_all(int pipe, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t count = write(pipe, text.data() + at, text.size() - at);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) at += static_cast<std::size_t>(count);
  }
  return true;
}

// Runs every `stride`-th job from `first`, since neighbours of a grid take about the same time.
[[noreturn]] void work(const std::vector<std::size_t>& jobs, std::size_t first, std::size_t stride, int pipe,
                       const std::function<std::string(std::size_t)>& line) {
  int status = 0;
  try {
    for (std::size_t i = first; i < jobs.size(); i += stride) {
      const std::string text = line(jobs[i]);
      if (text.empty()) break;
      if (!write_all(pipe, fmt::format("{} {}\n", jobs[i], text))) break;
    }
  } catch (const std::exception& error) {
    print_message(fmt::format("{}\n", error.what()));
    status = 1;
  }
  std::fflush(stderr);
  _exit(status);  // without destructors: the resources belong to the parent
}

Child start(const std::vector<std::size_t>& jobs, std::size_t first, std::size_t stride,
            const std::function<std::string(std::size_t)>& line) {
  int ends[2];
  const auto lost = [] {
    throw Error("sweep", {}, fmt::format("no process could be started: {}", std::strerror(errno)),
                "close other programs, or ask for fewer with --jobs", ErrorKind::tool);
  };
  if (::pipe(ends) != 0) lost();
  std::fflush(stdout);
  std::fflush(stderr);
  const pid_t id = fork();
  if (id < 0) lost();
  if (id == 0) {
    // Close all other files. Otherwise the child would keep the lock of a table after its parent was killed.
    const unsigned pipe = static_cast<unsigned>(ends[1]);
    ::close_range(STDERR_FILENO + 1, pipe - 1, 0);
    ::close_range(pipe + 1, ~0U, 0);
    work(jobs, first, stride, ends[1], line);
  }
  close(ends[1]);
  return {id, ends[0]};
}

}  // namespace

void run_in_processes(const std::vector<std::size_t>& jobs, std::size_t processes,
                      const std::function<std::string(std::size_t)>& line,
                      const std::function<void(std::size_t, const std::string&)>& done,
                      const std::atomic<bool>& interrupt) {
  const std::size_t count = std::min(processes, jobs.size());
  std::vector<Child> children;
  for (std::size_t first = 0; first < count; ++first) children.push_back(start(jobs, first, count, line));
  const auto take = [&](const std::string& text) {
    std::size_t job = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), job);
    done(job, std::string(stop + 1, text.data() + text.size()));
  };
  while (true) {
    std::vector<pollfd> waiting;
    std::vector<Child*> of;
    for (Child& child : children) {
      if (!child.open()) continue;
      waiting.push_back({child.pipe(), POLLIN, 0});
      of.push_back(&child);
    }
    if (waiting.empty()) return;
    constexpr int patience = 200;  // ms between checks for an interruption
    const int ready = poll(waiting.data(), waiting.size(), patience);
    if (interrupt) return;
    if (ready <= 0) continue;
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      if (waiting[i].revents == 0 || of[i]->read(take)) continue;
      throw Error("sweep", {}, "a process of the sweep ended before its runs were done",
                  "the rows that are there are kept, and the same command goes on from them; with --jobs 1 the run "
                  "that fails is the next one",
                  ErrorKind::tool);
    }
  }
}

}  // namespace eomgen::cli
