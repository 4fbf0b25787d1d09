// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/write_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "error.hpp"

namespace eomgen::emit {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path, int reason) {
  throw Error("emit", {}, what + " " + path + ": " + std::strerror(reason),
              "choose a folder that you may write to, with space left", Fault::tool);
}

void write_all(const std::string& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail("cannot write", path, errno);
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t n = ::write(file, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int reason = errno;
      ::close(file);
      ::unlink(path.c_str());
      fail("cannot write", path, reason);
    }
    written += static_cast<std::size_t>(n);
  }
  if (::close(file) != 0) {
    const int reason = errno;
    ::unlink(path.c_str());
    fail("cannot write", path, reason);
  }
}

}  // namespace

std::vector<std::string> write_files(const std::string& folder, const std::vector<EmittedFile>& files) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) fail("cannot make the folder", folder, failed.value());
  std::vector<std::string> paths, beside;
  const auto clean_up = [&beside] {
    for (const std::string& path : beside) ::unlink(path.c_str());
  };
  try {
    for (const EmittedFile& file : files) {
      paths.push_back((std::filesystem::path(folder) / file.name).string());
      beside.push_back(paths.back() + ".part" + std::to_string(::getpid()));
      write_all(beside.back(), file.text);
    }
  } catch (...) {
    clean_up();
    throw;
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (std::rename(beside[i].c_str(), paths[i].c_str()) != 0) {
      const int reason = errno;
      clean_up();
      fail("cannot put in place", paths[i], reason);
    }
  }
  return paths;
}

}  // namespace eomgen::emit
