// SPDX-License-Identifier: MIT
// Makes primitives of arrays: accessors of a file, or a caller's memory. All checks of geometry are
// here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/motion.hpp"

namespace clpv {

/// Numbers of an attribute or of indices: elements of some components each.
struct NumberArray {
  virtual ~NumberArray() = default;
  virtual std::size_t count() const = 0;  ///< elements
  virtual int components() const = 0;
  /// One component of an element, which must be in range.
  virtual double number(std::size_t element, int component) const = 0;
  /// The same as an unsigned integer, of arrays of indices.
  virtual std::uint32_t index(std::size_t element, int component = 0) const = 0;
  /// Throws Error(bad_input) that names the array and the element.
  [[noreturn]] virtual void reject_element(std::size_t element, const std::string& found,
                                           const std::string& allowed) const = 0;

  /// As number(). Throws Error(bad_input) for infinity and NaN.
  double finite(std::size_t element, int component) const;
};

/// Three finite numbers of an element.
glm::dvec3 vector_in(const NumberArray& from, std::size_t element);

/// How corners make triangles (glTF 2.0, section 3.7.2.1).
enum class TriangleOrder { list, strip, fan };

/// Arrays of a primitive; null if absent. Arrays of vertices have as many elements as `positions`.
struct PrimitiveArrays {
  const NumberArray* positions = nullptr;
  const NumberArray *normals = nullptr, *uvs = nullptr, *colours = nullptr;
  const NumberArray* indices = nullptr;  ///< corners, one component; absent: 0, 1, 2, ...
  TriangleOrder order = TriangleOrder::list;
  glm::dmat3 uv_transform{1.0};
  bool smooth = false;  ///< without normals: means of the triangles' normals, weighted by angle, in
                        ///< place of flat ones
};

/// Geometry that the scene may still add.
struct GeometryBudget {
  std::uint64_t vertices, triangles;
  std::uint64_t morph_numbers;  ///< numbers in morph targets
};

/// Makes a primitive, without joints and morph targets. `file` and `place` are for messages.
/// `slots` is scratch memory, kNoSlot between calls, as primitives often share one large array.
/// Throws Error(bad_input) for numbers that are not finite, indices out of range, and more geometry
/// than `budget`.
LocalPrimitive make_primitive(const PrimitiveArrays& arrays, const std::string& file,
                              std::string place, std::uint32_t material,
                              const GeometryBudget& budget, std::vector<std::uint32_t>& slots);

inline constexpr std::uint32_t kNoSlot = 0xffffffff;

/// Moves a primitive's vertices, indexed by LocalVertex::source. Stored normals stay unless
/// `normals` replaces them; others are computed again. Throws Error(bad_input) for numbers that are
/// not finite.
void move_vertices(LocalPrimitive& primitive, const NumberArray& positions,
                   const NumberArray* normals);

}  // namespace clpv
