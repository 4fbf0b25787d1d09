// SPDX-License-Identifier: GPL-3.0-or-later
// The library parses in place: names and values are pointers into the buffer, which gives every attribute its column.
#include "import/xml.hpp"

#include <fmt/format.h>

#include <pugixml.hpp>

#include "model/names.hpp"
#include "utf8.hpp"

namespace eomgen::import {
namespace {

/// Lines of a file by byte offset.
class Lines {
 public:
  Lines(const std::string& file, const std::string& bytes) : file_(file), bytes_(bytes), starts_{0} {
    for (std::size_t i = 0; i < bytes.size(); ++i)
      if (bytes[i] == '\n') starts_.push_back(i + 1);
  }
  SourceLocation where(std::size_t offset, std::size_t length) const {
    offset = std::min(offset, bytes_.size());
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
    const std::size_t line = static_cast<std::size_t>(after - starts_.begin());
    const std::size_t start = starts_[line - 1];
    std::string text = bytes_.substr(start, std::min<std::size_t>(bytes_.find('\n', start) - start, 1000));
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return {file_, static_cast<std::uint32_t>(line), static_cast<std::uint32_t>(offset - start + 1),
            static_cast<std::uint32_t>(length), std::move(text)};
  }

 private:
  const std::string& file_;
  const std::string& bytes_;
  std::vector<std::size_t> starts_;
};

void require_text(const Lines& lines, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const auto byte = static_cast<unsigned char>(bytes[at]);
    const std::size_t length = utf8_length(std::string_view(bytes).substr(at));
    const bool is_control = (byte < 0x20 && byte != '\n' && byte != '\t' && byte != '\r') || byte == 0x7f;
    if (length == 0 || is_control)
      fail(lines.where(at, 1), fmt::format("byte 0x{:02x} is no text in UTF-8", byte),
           "save the file as UTF-8 without control characters");
    at += length;
  }
}

/// The elements below a node of the library, without recursion beyond max_xml_depth.
class Builder {
 public:
  Builder(const Lines& lines, const std::string& buffer) : lines_(lines), buffer_(buffer) {}

  Element element(const pugi::xml_node& node, std::size_t depth) {
    const SourceLocation where = place(node.name(), node.offset_debug());
    if (depth > max_xml_depth)
      fail(where, fmt::format("elements are nested more than {} deep", max_xml_depth),
           "check that this is a robot file; divide a chain of so many bodies");
    if (++elements_ > max_xml_elements)
      fail(where, fmt::format("the file has more than {} elements", max_xml_elements), "divide the robot into parts");
    Element result{node.name(), node.text().get(), where, {}, {}};
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      const SourceLocation at = place(attribute.name(), node.offset_debug());
      if (result.find(attribute.name()) != nullptr)
        fail(at, fmt::format("the attribute {} comes twice", model::quote(attribute.name())), "remove one of them");
      result.attributes.push_back({attribute.name(), attribute.value(), at});
    }
    for (const pugi::xml_node& child : node.children())
      if (child.type() == pugi::node_element) result.children.push_back(element(child, depth + 1));
    return result;
  }

 private:
  SourceLocation place(const char* name, std::ptrdiff_t otherwise) const {
    const std::less<const char*> before;
    const bool inside = !before(name, buffer_.data()) && before(name, buffer_.data() + buffer_.size());
    const std::ptrdiff_t offset = inside ? name - buffer_.data() : std::max<std::ptrdiff_t>(otherwise, 0);
    return lines_.where(static_cast<std::size_t>(offset), std::char_traits<char>::length(name));
  }

  const Lines& lines_;
  const std::string& buffer_;
  std::size_t elements_ = 0;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

[[noreturn]] void fail_number(const Attribute& attribute, std::string_view text) {
  fail(attribute.where, fmt::format("{} is not a decimal number within 1e-300 .. 1e300", model::quote(text)),
       text.find("${") != std::string_view::npos ? "expand macros first: xacro robot.urdf.xacro > robot.urdf"
                                                 : fmt::format("write {}=\"0.5\", for example", attribute.name));
}

Number parse_number_of(const Attribute& attribute, std::string_view text) {
  const std::optional<Number> number = parse_number(text);
  if (!number) fail_number(attribute, text);
  return *number;
}

}  // namespace

void fail(const SourceLocation& where, std::string what, std::string remedy) {
  throw Error("import", where, std::move(what), std::move(remedy));
}

const Attribute* Element::find(std::string_view attribute) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.name == attribute; });
  return found == attributes.end() ? nullptr : &*found;
}

Element parse_xml(const std::string& file, const std::string& bytes) {
  const SourceLocation whole{file, 0, 0, 1, ""};
  if (bytes.size() > max_xml_bytes)
    fail(whole, fmt::format("the file has more than {} bytes", max_xml_bytes),
         "check that this is a robot file without meshes in it");
  const Lines lines(file, bytes);
  require_text(lines, bytes);
  std::string buffer = bytes;
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(
      buffer.data(), buffer.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (!parsed)
    fail(lines.where(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), 1),
         fmt::format("this is not XML: {}", parsed.description()), "close every element, and put values in quotes");
  pugi::xml_node root;
  for (const pugi::xml_node& node : document.children()) {
    if (node.type() == pugi::node_doctype)
      fail(lines.where(bytes.find("<!DOCTYPE"), 9), "a robot file has no document type", "remove <!DOCTYPE ..>");
    if (node.type() != pugi::node_element) continue;
    if (root)
      fail(lines.where(static_cast<std::size_t>(node.offset_debug()), 1), "the file has several root elements",
           "a file has one robot");
    root = node;
  }
  if (!root) fail(whole, "the file has no element", "a robot file has <robot name=\"..\"> around links and joints");
  return Builder(lines, buffer).element(root, 1);
}

const Attribute& require_attribute(const Element& element, std::string_view name) {
  const Attribute* found = element.find(name);
  if (found == nullptr || trimmed(found->value).empty())
    fail(found == nullptr ? element.where : found->where, fmt::format("<{}> has no {}", element.name, name),
         fmt::format("write <{} {}=\"..\">", element.name, name));
  return *found;
}

Number number_of(const Attribute& attribute) { return parse_number_of(attribute, trimmed(attribute.value)); }

std::vector<Number> numbers_of(const Attribute& attribute, std::size_t least, std::size_t most) {
  std::vector<Number> result;
  std::string_view rest = trimmed(attribute.value);
  std::size_t count = 0;
  for (; !rest.empty(); ++count) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\n\r"));
    if (count < most) result.push_back(parse_number_of(attribute, word));
    rest = trimmed(rest.substr(word.size()));
  }
  if (count >= least && count <= most) return result;
  const std::string needed = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  fail(attribute.where, fmt::format("'{}' has {} numbers", attribute.name, count),
       most == 3 && least == 3
           ? fmt::format("write {}=\"0 0 1\": three numbers with blanks between them", attribute.name)
           : fmt::format("write {} numbers with blanks between them", needed));
}

Vector vector_of(const Attribute& attribute) {
  const std::vector<Number> numbers = numbers_of(attribute, 3, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

const Element* only_child(const Element& element, std::string_view name) {
  const Element* found = nullptr;
  for (const Element& child : element.children) {
    if (child.name != name) continue;
    if (found != nullptr)
      fail(child.where, fmt::format("<{}> has <{}> twice", element.name, name), "remove one of them");
    found = &child;
  }
  return found;
}

const Element& require_child(const Element& element, std::string_view name) {
  const Element* found = only_child(element, name);
  if (found == nullptr)
    fail(element.where, fmt::format("<{}> has no <{}>", element.name, name), fmt::format("add <{} ../>", name));
  return *found;
}

void report_unknown(const Element& element, const std::vector<std::string_view>& attributes,
                    const std::vector<std::string_view>& children, Findings& findings) {
  const auto has = [](const std::vector<std::string_view>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const Attribute& attribute : element.attributes)
    if (!has(attributes, attribute.name) && !attribute.name.starts_with("xmlns"))
      findings.add(fmt::format("{}=\"..\" of <{}>", attribute.name, element.name), "it has no meaning in a model",
                   attribute.where);
  for (const Element& child : element.children)
    if (!has(children, child.name))
      findings.add(fmt::format("<{}> of <{}>", child.name, element.name), "it has no meaning in a model", child.where);
}

}  // namespace eomgen::import
