// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/write_files.hpp"

#include <cerrno>
#include <eom/output/atomic_file.hpp>
#include <filesystem>

namespace eomgen::emit {
namespace {

[[noreturn]] void fail(const std::string& what, const std::error_code& reason) {
  throw Error("emit", {}, what, "choose a folder that you may write to, with space left", write_fault(reason));
}

}  // namespace

ErrorKind write_fault(const std::error_code& reason) {
  for (const std::errc lost :
       {std::errc::no_space_on_device, std::errc::io_error, std::errc::file_too_large, std::errc::broken_pipe,
        std::errc::too_many_files_open, std::errc::too_many_files_open_in_system}) {
    if (reason == lost) return ErrorKind::tool;
  }
  return reason.value() == EDQUOT ? ErrorKind::tool : ErrorKind::input;
}

std::vector<std::string> write_files(const std::string& folder, const std::vector<EmittedFile>& files) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) fail("cannot make the folder " + folder + ": " + failed.message(), failed);
  std::vector<std::string> paths;
  std::vector<eom::AtomicFile> beside;
  try {
    for (const EmittedFile& file : files) {
      paths.push_back((std::filesystem::path(folder) / file.name).string());
      beside.emplace_back(paths.back());
      beside.back().write(file.text);
    }
    for (eom::AtomicFile& file : beside) file.finish();
  } catch (const std::system_error& error) {
    for (eom::AtomicFile& file : beside) file.discard();
    fail(error.what(), error.code());
  }
  return paths;
}

}  // namespace eomgen::emit
