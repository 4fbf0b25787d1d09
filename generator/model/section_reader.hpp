// SPDX-License-Identifier: GPL-3.0-or-later
// The common base of the section readers. Each section is read by one class derived from SectionReader, on one
// ReaderContext: the file as values, the Model under construction, the names, and the declarations that are resolved on
// demand.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "model/resolver.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_places = 1000;
inline constexpr std::size_t max_coordinates = 1000;
inline constexpr std::size_t max_scenes = 100;
inline constexpr long max_chain = 64;

/// The keys of one kind of table, and common synonyms.
struct Keys {
  std::string what;  // "[[particle]]"
  std::vector<std::string_view> known;
  std::map<std::string, std::string, std::less<>> synonyms{};  // synonym -> advice on the key to use
};

/// The declaration of a place.
struct PlaceDeclaration {
  const Value* table = nullptr;
  bool particle = false;
  bool body = false;
  std::uint32_t chain = 0;  // index + 1 into ReaderContext::chains, for links
  long link = 0;            // from 1
};

struct Chain {
  const Value* table = nullptr;
  std::string name;
  long n = 0;
  bool relative = false;
  std::vector<std::uint32_t> coordinates, places;
};

/// A direction that is fixed in a frame and in space: the components of its unit vector along the axes of the frame,
/// and, if it is numerical, numbers proportional to them.
struct FixedDirection {
  std::array<TypedNode, 3> unit;
  std::optional<std::array<cln::cl_RA, 3>> numbers;
};

/// The declaration of axes.
struct FrameDeclaration {
  const Value* table = nullptr;
  std::uint32_t place = 0;                  // of a body
  bool keeps_attitude = false;              // it does not rotate, like the ground
  std::optional<FixedDirection> axis = {};  // its axis of rotation, if that is fixed
  bool starts_aligned =
      false;  // it rotates about that axis only, starting from E1, E2, E3: the axis has the same components in space

  /// Whether its axes are E1, E2, E3 for ever.
  bool has_axes_of_space() const { return starts_aligned && !axis; }
};

struct ReaderContext {
  ReaderContext(const Source& file, const Value& tree);
  ReaderContext(const ReaderContext&) = delete;
  ReaderContext& operator=(const ReaderContext&) = delete;

  const Source& source;
  const Value& root;
  Model model;
  Scope scope;
  std::function<TypedNode(Symbol&)> define;  // reads the declaration of a symbol on demand
  Resolver resolver;
  std::vector<PlaceDeclaration> place_sources;  // per Model::places
  std::vector<FrameDeclaration> frame_sources;  // per Model::frames
  std::vector<Chain> chains;
  std::vector<ShapeSpec> contact_shapes;  // spheres and disks in contact
  std::vector<Value> contact_lengths;     // of shapes of [[contact]], as expressions
  std::set<std::uint32_t> coordinates_with_range,
      coordinates_with_unit;             // coordinates whose range or unit [coordinates] states
  std::string folder;                    // of files that the model names; empty: it may name none
  std::vector<std::string> data_hashes;  // of the contents of these files
};

class SectionReader {
 protected:
  explicit SectionReader(ReaderContext& context);

  // keys.cpp
  void check_keys(const Value& table, const Keys& keys) const;
  const Value& require_value(const Value& table, std::string_view key, const std::string& what,
                             const std::string& remedy) const;
  const Value& require_kind(Value::Kind kind, const Value& value, const std::string& what,
                            const std::string& remedy) const;
  const Value* section(std::string_view name) const;                // [name], checked to be a table
  std::vector<const Value*> sections(std::string_view name) const;  // [[name]]
  std::string text_of_key(const Value& table, std::string_view key, const std::string& what) const;
  Span key_span(const Value& table, std::string_view key) const;
  std::string tex_of(const Value& table, const std::string& what) const;
  /// Reads a unit for values: SI without a factor.
  Unit si_unit(const Value& value, const std::string& what) const;
  MeasuredUnit any_unit(const Value& value, const std::string& what) const;

  // section_reader.cpp
  /// The index into Model::places of a named place, 0 for "origin". Throws Error if there is no such place.
  std::uint32_t require_place(const Value& value, const std::string& what);
  /// The index into Model::frames of a named body or frame, 0 for "ground". Throws Error if there is none.
  std::uint32_t require_frame(const Value& value, const std::string& what);
  /// A position given as the name of a place or as a vector.
  TypedNode point(const Value& value, const std::string& what);

  ReaderContext& context_;
  const Source& source_;
  const Value& root_;
  Model& model_;
  Scope& scope_;
  Resolver& resolver_;
  std::vector<PlaceDeclaration>& place_sources_;
  std::vector<FrameDeclaration>& frame_sources_;
  std::vector<Chain>& chains_;
  std::set<std::uint32_t>&coordinates_with_range_, &coordinates_with_unit_;
};

}  // namespace eomgen::model
