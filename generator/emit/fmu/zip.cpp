// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/zip.hpp"

#include <minizip/zip.h>

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <system_error>
#include <utility>

namespace eomgen::emit {

ZipWriter::ZipWriter(std::FILE* stream, std::string name) : name_(std::move(name)) {
  if (stream == nullptr) require(ZIP_ERRNO);
  zlib_filefunc64_def functions;
  fill_fopen64_filefunc(&functions);
  functions.opaque = stream;
  functions.zopen64_file = [](void* opened, const void*, int) { return opened; };
  archive_ = zipOpen2_64(nullptr, APPEND_STATUS_CREATE, nullptr, &functions);
  if (archive_ == nullptr) throw std::bad_alloc();
}

ZipWriter::~ZipWriter() {
  if (archive_ != nullptr) zipClose(archive_, nullptr);
}

void ZipWriter::require(int status) const {
  if (status != ZIP_OK) throw std::system_error(errno, std::generic_category(), "cannot write " + name_);
}

void ZipWriter::start(const std::string& entry, std::uint64_t bytes) {
  constexpr int stored = 0, version = 20, names_are_utf8 = 0x800;
  constexpr std::uint64_t largest = 0xfffffffe;  // without the fields of 64 bits
  zip_fileinfo first_day{};
  first_day.dosDate = 0x210000;  // 1980-01-01
  require(zipOpenNewFileInZip4_64(archive_, entry.c_str(), &first_day, nullptr, 0, nullptr, 0, nullptr, stored, 0, 0,
                                  -MAX_WBITS, DEF_MEM_LEVEL, Z_DEFAULT_STRATEGY, nullptr, 0, version, names_are_utf8,
                                  bytes > largest ? 1 : 0));
}

void ZipWriter::write(std::string_view bytes) {
  constexpr std::size_t most = 1 << 30;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), most)))
    require(zipWriteInFileInZip(archive_, bytes.data(), static_cast<unsigned>(std::min(bytes.size(), most))));
}

void ZipWriter::finish() { require(zipClose(std::exchange(archive_, nullptr), nullptr)); }

std::string zip(const std::vector<EmittedFile>& files) {
  char* text = nullptr;
  std::size_t size = 0;
  ZipWriter archive(::open_memstream(&text, &size), "an archive in memory");
  for (const EmittedFile& file : files) {
    archive.start(file.name, file.text.size());
    archive.write(file.text);
  }
  archive.finish();
  const std::unique_ptr<char, decltype(&std::free)> owner(text, &std::free);
  return std::string(text, size);
}

}  // namespace eomgen::emit
