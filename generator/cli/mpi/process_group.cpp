// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/mpi/process_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <thread>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
// Open MPI leaks memory, also in libraries that are unloaded by then, so suppressions cannot name the functions.
extern "C" int __lsan_is_turned_off() { return 1; }
#endif
#endif

namespace eomgen::cli {
namespace {

constexpr int asks = 1, answers = 2;              // tags
constexpr std::uint64_t most_in_block = 1 << 16;  // runs; limits the memory of a block

void rest() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

void await(MPI_Request& request) {
  for (int there = 0; MPI_Test(&request, &there, MPI_STATUS_IGNORE), there == 0;) rest();
}

int whole(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("more pieces of a table than MPI counts");
  return static_cast<int>(count);
}

}  // namespace

MpiProcessGroup::MpiProcessGroup(int& argc, char**& argv) {
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine_);
}

MpiProcessGroup::~MpiProcessGroup() {
  MPI_Comm_free(&machine_);
  MPI_Finalize();
}

void MpiProcessGroup::broadcast(Phase phase, std::uint64_t run) {
  std::uint64_t words[2] = {static_cast<std::uint64_t>(phase), run};
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(words, 2, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
  await(request);
  phase_ = static_cast<Phase>(words[0]);
  run_ = words[1];
}

bool MpiProcessGroup::await_start() {
  broadcast(Phase::waiting, 0);
  return phase_ != Phase::stop;
}

void MpiProcessGroup::start_workers(std::optional<std::uint64_t> run) {
  broadcast(run ? Phase::work : Phase::nothing, run.value_or(0));
}

std::optional<std::uint64_t> MpiProcessGroup::first_run() const {
  return phase_ == Phase::work ? std::optional(run_) : std::nullopt;
}

void MpiProcessGroup::leave(int code) {
  if (is_leader() && phase_ == Phase::waiting) return broadcast(Phase::stop, 0);
  if (phase_ != Phase::stop && !released_) MPI_Abort(MPI_COMM_WORLD, code == 0 ? 1 : code);
}

void MpiProcessGroup::run_once_per_host(const std::function<void()>& work) {
  int place = 0;
  MPI_Comm_rank(machine_, &place);
  if (place == 0) work();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(machine_, &request);
  await(request);
  if (place != 0) work();
}

void MpiProcessGroup::distribute(std::vector<RunRange> open, std::uint64_t least, const std::atomic<bool>& stop) {
  std::uint64_t left = 0;
  for (const RunRange& stretch : open) left += stretch.count;
  std::reverse(open.begin(), open.end());
  for (int waiting = size_ - 1; waiting > 0;) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, asks, MPI_COMM_WORLD, &there, &status);
    if (there == 0) {
      rest();
      continue;
    }
    MPI_Recv(nullptr, 0, MPI_UINT64_T, status.MPI_SOURCE, asks, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    std::uint64_t words[2] = {0, 0};
    if (open.empty() || stop) {
      --waiting;
    } else {
      // Blocks decrease in size, so that all workers finish at about the same time.
      const std::uint64_t share = std::clamp(left / (4 * workers()), least, std::max(least, most_in_block));
      words[0] = open.back().first;
      words[1] = std::min(share, open.back().count);
      open.back().first += words[1];
      open.back().count -= words[1];
      left -= words[1];
      if (open.back().count == 0) open.pop_back();
    }
    MPI_Send(words, 2, MPI_UINT64_T, status.MPI_SOURCE, answers, MPI_COMM_WORLD);
  }
}

std::optional<RunRange> MpiProcessGroup::next_block() {
  MPI_Send(nullptr, 0, MPI_UINT64_T, 0, asks, MPI_COMM_WORLD);
  std::uint64_t words[2] = {0, 0};
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(words, 2, MPI_UINT64_T, 0, answers, MPI_COMM_WORLD, &request);
  await(request);
  if (words[1] == 0) return std::nullopt;
  return RunRange{words[0], words[1]};
}

std::uint64_t MpiProcessGroup::sum(std::uint64_t of_this_one) {
  std::uint64_t all = 0;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Iallreduce(&of_this_one, &all, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD, &request);
  await(request);
  return all;
}

/// File offsets of the pieces of this process. The leader sorts the pieces of all processes.
std::vector<std::uint64_t> MpiProcessGroup::offsets(std::uint64_t begin, const std::vector<TableSegment>& pieces) {
  std::vector<std::uint64_t> mine, all;  // pairs: first run, bytes
  for (const TableSegment& piece : pieces) mine.insert(mine.end(), {piece.where.first, piece.bytes});
  std::vector<int> counts(size()), places(size()), halves(size()), half_places(size());
  const int count = whole(mine.size());
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (is_leader()) {
    whole(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
    std::transform(counts.begin(), counts.end(), halves.begin(), [](int n) { return n / 2; });
    std::exclusive_scan(halves.begin(), halves.end(), half_places.begin(), 0);
    all.resize(static_cast<std::size_t>(places.back()) + static_cast<std::size_t>(counts.back()));
  }
  MPI_Gatherv(mine.data(), count, MPI_UINT64_T, all.data(), counts.data(), places.data(), MPI_UINT64_T, 0,
              MPI_COMM_WORLD);
  std::vector<std::uint64_t> where(all.size() / 2), own(pieces.size());
  std::vector<std::size_t> order(where.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&all](std::size_t a, std::size_t b) { return all[2 * a] < all[2 * b]; });
  for (const std::size_t i : order) {
    where[i] = begin;
    begin += all[2 * i + 1];
  }
  MPI_Scatterv(where.data(), halves.data(), half_places.data(), MPI_UINT64_T, own.data(), count / 2, MPI_UINT64_T, 0,
               MPI_COMM_WORLD);
  return own;
}

/// Returns in all processes the error of any process, or "".
std::string MpiProcessGroup::agreed(const std::string& why) {
  int first = why.empty() ? size_ : rank_, least = size_;
  MPI_Allreduce(&first, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (least == size_) return "";
  int length = static_cast<int>(why.size());
  MPI_Bcast(&length, 1, MPI_INT, least, MPI_COMM_WORLD);
  std::string reason(static_cast<std::size_t>(length), ' ');
  if (rank_ == least) reason = why;
  MPI_Bcast(reason.data(), length, MPI_CHAR, least, MPI_COMM_WORLD);
  return reason;
}

std::string MpiProcessGroup::write(const std::string& path, std::uint64_t begin,
                                   const std::vector<TableSegment>& pieces,
                                   const std::function<std::string(std::size_t)>& text) {
  std::string place = path, why;
  int length = static_cast<int>(place.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
  place.resize(static_cast<std::size_t>(length));
  MPI_Bcast(place.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
  const std::vector<std::uint64_t> where = offsets(begin, pieces);

  const auto note = [&](int code) {
    if (code == MPI_SUCCESS || !why.empty()) return;
    char message[MPI_MAX_ERROR_STRING];
    int written = 0;
    MPI_Error_string(code, message, &written);
    why = fmt::format("cannot write {}: {}", place, std::string(message, static_cast<std::size_t>(written)));
  };
  MPI_File file = MPI_FILE_NULL;
  note(MPI_File_open(MPI_COMM_WORLD, place.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file));
  why = agreed(why);
  if (!why.empty()) return why;
  // All processes write in the same number of rounds, so that collective writes give the file system large requests.
  const std::uint64_t mine = pieces.size();
  std::uint64_t rounds = 0;
  MPI_Allreduce(&mine, &rounds, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const bool has = round < mine && why.empty();
    const std::string bytes = has ? text(round) : std::string();
    MPI_Status status;
    note(MPI_File_write_at_all(file, has ? static_cast<MPI_Offset>(where[round]) : 0, bytes.data(),
                               static_cast<int>(bytes.size()), MPI_CHAR, &status));
    int written = 0;
    MPI_Get_count(&status, MPI_CHAR, &written);
    if (why.empty() && written != static_cast<int>(bytes.size()))
      why = fmt::format("cannot write {}: the disk is full", place);
  }
  note(MPI_File_close(&file));
  return agreed(why);
}

void MpiProcessGroup::release() {
  sum(0);
  released_ = true;
}

}  // namespace eomgen::cli
