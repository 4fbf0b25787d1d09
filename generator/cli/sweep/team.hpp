// SPDX-License-Identifier: GPL-3.0-or-later
// Several processes, maybe on several machines, that make one sweep. The first hands out runs in blocks and makes none
// where there are others; each of the others keeps the rows that it makes in a file of its own, and all together write
// the table.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::cli {

/// Runs that follow one another in the table, by their places in it.
struct Stretch {
  std::uint64_t first = 0, count = 0;
};

class Team {
 public:
  virtual ~Team() = default;
  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;
  bool leads() const { return rank() == 0; }
  std::size_t workers() const { return size() > 1 ? size() - 1 : 1; }

  /// Of the first one: all that can be wrong before the work has been looked at; the others begin with this run, if
  /// there is any to make.
  virtual void go(std::optional<std::uint64_t> run) = 0;
  /// What go() was called with, for the others.
  virtual std::optional<std::uint64_t> gone() const = 0;
  /// First one process of each machine, then its others: what the first compiles the others find.
  virtual void one_by_machine(const std::function<void()>& work) = 0;

  /// Of the first one: answers the others until all of `open` is handed out, or `stop`. A block has `least` runs or
  /// more.
  virtual void hand_out(std::vector<Stretch> open, std::uint64_t least, const std::atomic<bool>& stop) = 0;
  /// Of the others: the next block, or none.
  virtual std::optional<Stretch> next() = 0;

  virtual std::uint64_t sum(std::uint64_t of_this_one) = 0;

  struct Piece {
    Stretch where;
    std::uint64_t bytes = 0;
  };
  /// Writes the pieces of all behind one another, in the order of the table, to what the first one calls `path`, from
  /// `begin` on. Returns
  /// "" or, for all, why that failed.
  virtual std::string write(const std::string& path, std::uint64_t begin, const std::vector<Piece>& pieces,
                            const std::function<std::string(std::size_t piece)>& text) = 0;
  /// Waits for all. From now on nobody needs the others.
  virtual void part() = 0;
};

}  // namespace eomgen::cli
