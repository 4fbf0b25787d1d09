// SPDX-License-Identifier: GPL-3.0-or-later
// Files that a model or a robot file names. Paths and contents are untrusted: a path stays in the folder of the file
// that names it, and bytes are bounded.
// In: folder, path, largest size. Out: the bytes, or the reason why they are not read.
#pragma once

#include <cstddef>
#include <exception>
#include <string>

namespace eomgen::model {

enum class DataFileProblem { no_folder, outside, missing, unreadable, too_large };

/// A file that is not read: the kind of the problem, what is wrong with the path, and what to do. The caller knows the
/// place in the user's file that names the path.
class DataFileError : public std::exception {
 public:
  DataFileError(DataFileProblem problem, std::string message, std::string remedy);

  const char* what() const noexcept override { return message_.c_str(); }
  DataFileProblem problem() const noexcept { return problem_; }
  const std::string& message() const noexcept { return message_; }
  const std::string& remedy() const noexcept { return remedy_; }

 private:
  DataFileProblem problem_;
  std::string message_, remedy_;
};

/// The bytes of a file. Throws DataFileError if there is no folder, the path is absolute or leaves the folder, or it
/// names no regular file of at most `most` bytes.
std::string read_data_file(const std::string& folder, const std::string& path, std::size_t most);

}  // namespace eomgen::model
