// SPDX-License-Identifier: GPL-3.0-or-later
// XML files with the place of every element and attribute, bounded in size and depth. The files are untrusted: no
// document types, no entities beyond XML's own five, no control characters.
// In: the bytes of a file. Out: elements; every error is an Error with file:line:column.
#pragma once

#include <string>
#include <vector>

#include "error.hpp"
#include "import/findings.hpp"
#include "import/rigid.hpp"

namespace eomgen::import {

/// Largest file in bytes, deepest nesting of elements, most elements.
inline constexpr std::size_t max_xml_bytes = std::size_t{1} << 22;
inline constexpr std::size_t max_xml_depth = 200;
inline constexpr std::size_t max_xml_elements = 100000;

struct Attribute {
  std::string name, value;
  SourceLocation where;  // of the name
};

/// An element as plain data. Text between tags is in `text`, without surrounding blanks.
struct Element {
  std::string name, text;
  SourceLocation where;  // of the name
  std::vector<Attribute> attributes;
  std::vector<Element> children;

  const Attribute* find(std::string_view attribute) const;
};

/// Parses a file into its root element. Throws Error.
Element parse_xml(const std::string& file, const std::string& bytes);

[[noreturn]] void fail(const SourceLocation& where, std::string what, std::string remedy);

/// The value of an attribute. Throws Error if it is missing or empty.
const Attribute& require_attribute(const Element& element, std::string_view name);
/// The number in an attribute; throws Error if it is none.
Number number_of(const Attribute& attribute);
/// The numbers in an attribute; throws Error if there are fewer or more.
std::vector<Number> numbers_of(const Attribute& attribute, std::size_t least, std::size_t most);
/// An attribute of three numbers; throws Error otherwise.
Vector vector_of(const Attribute& attribute);
/// The only child of that name; nullptr without one. Throws Error if there are several.
const Element* only_child(const Element& element, std::string_view name);
const Element& require_child(const Element& element, std::string_view name);
/// Reports attributes and children whose names are not listed as left out.
void report_unknown(const Element& element, const std::vector<std::string_view>& attributes,
                    const std::vector<std::string_view>& children, Findings& findings);

}  // namespace eomgen::import
