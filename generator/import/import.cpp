// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "import/model_text.hpp"
#include "import/xml.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

std::string read_bytes(const std::string& path) {
  const SourceLocation whole{path, 0, 0, 1, ""};
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (!std::filesystem::exists(status)) fail(whole, "there is no such file", "check the path");
  if (std::filesystem::is_directory(status))
    fail(whole, "this is a directory", "name a robot file, such as robot.urdf");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(whole, "the file cannot be read", "check its permissions");
  std::string bytes(max_xml_bytes + 1, '\0');  // one byte more than allowed, to detect a file that is too large
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) fail(whole, "the file cannot be read", "check the file");
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

ImportedModel import_text(const std::string& file, const std::string& bytes, const ImportOptions& options) {
  const Element root = parse_xml(file, bytes);
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    known.push_back(fmt::format("<{}> ({})", format.root, format.title));
    if (root.name != format.root) continue;
    Robot robot = format.read(root, options);
    const Tree tree = build_tree(robot);
    const Assembly assembly = assemble(robot, tree);
    ImportedModel model = ModelWriter(robot, tree, assembly, options).write();
    model.format = format.name;
    return model;
  }
  fail(root.where, fmt::format("<{}> is not the root of a robot file", root.name),
       fmt::format("files have the root {}", fmt::join(known, " or ")));
}

ImportedModel import_file(const std::string& path, const ImportOptions& options) {
  ImportOptions here = options;
  here.folder = std::filesystem::path(path).parent_path().string();
  if (here.folder.empty()) here.folder = ".";
  return import_text(path, read_bytes(path), here);
}

}  // namespace eomgen::import
