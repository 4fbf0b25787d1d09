// SPDX-License-Identifier: GPL-3.0-or-later
#include "work.hpp"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <utility>

namespace eomgen::work {
namespace {

// Static storage: the signal handler and the progress thread can access nothing else.
std::atomic<bool> stop{false};
std::atomic<const char*> under_way{nullptr};
std::atomic<int> keeping{0};
static_assert(std::atomic<bool>::is_always_lock_free);

std::mutex line;  // on the terminal
bool line_is_shown = false;

thread_local Listener* listener = nullptr;
thread_local std::size_t left = std::numeric_limits<std::size_t>::max();

}  // namespace

void request_stop() noexcept { stop.store(true, std::memory_order_relaxed); }

DeferInterrupt::DeferInterrupt() noexcept
    : count_(listener != nullptr && listener->stop_ != nullptr ? listener->deferred_ : keeping) {
  ++count_;
  clear_line();
}
DeferInterrupt::~DeferInterrupt() { --count_; }

bool stop_requested() noexcept {
  const bool own = listener != nullptr && listener->stop_ != nullptr;
  const bool asked = stop.load(std::memory_order_relaxed) || (own && listener->stop_->load(std::memory_order_relaxed));
  return asked && keeping.load(std::memory_order_relaxed) == 0 &&
         (!own || listener->deferred_.load(std::memory_order_relaxed) == 0);
}

Listener::Listener(const std::atomic<bool>* asked) noexcept : stop_(asked), around_(std::exchange(listener, this)) {}
Listener::~Listener() { listener = around_; }
void Listener::on_stage(const char*) {}
void Listener::on_warning(const std::string&) {}

void warn(const std::string& text) {
  if (listener != nullptr) listener->on_warning(text);
}

const std::atomic<bool>& stop_flag() noexcept {
  return listener != nullptr && listener->stop_ != nullptr ? *listener->stop_ : stop;
}

void throw_if_stopped() {
  if (stop_requested()) throw Interrupted{};
}

void consume_budget(std::size_t operations) {
  throw_if_stopped();
  if (operations > left) {
    left = 0;
    throw BudgetExceeded("more operations than are spent on it");
  }
  left -= operations;
}

Budget::Budget(std::size_t operations) : around_(left), given_(std::min(operations, left)) { left = given_; }
Budget::~Budget() { left = around_ - (given_ - left); }

Stage::Stage(const char* name) : around_(under_way.exchange(name)) {
  if (listener != nullptr) listener->on_stage(name);
}
Stage::~Stage() {
  under_way.store(around_);
  if (around_ == nullptr) clear_line();
}

void show_line(const char* text) {
  const std::lock_guard lock(line);
  if (current_stage() == nullptr || keeping != 0) return;
  std::fprintf(stderr, "\r\033[K%s", text);
  std::fflush(stderr);
  line_is_shown = true;
}

void clear_line() noexcept {
  const std::lock_guard lock(line);
  if (line_is_shown) std::fputs("\r\033[K", stderr);
  line_is_shown = false;
}

const char* current_stage() noexcept { return under_way.load(); }

}  // namespace eomgen::work
