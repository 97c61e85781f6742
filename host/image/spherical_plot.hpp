// Spherical plots: functions f on the sphere as the surfaces |f(w)| w, lit, with axes; z is up.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "image/image.hpp"

namespace clpv {

struct PlottedFunction {
  std::function<double(const glm::dvec3&)> value;  ///< of unit vectors
  glm::vec3 positive, negative;                    ///< linear colours of f > 0 and f < 0
};

inline constexpr glm::vec3 kPositiveColour{0.07f, 0.26f, 0.62f};  ///< a blue
inline constexpr glm::vec3 kNegativeColour{0.85f, 0.16f, 0.03f};  ///< a vermilion

/// A sphere of which only the silhouette is drawn, over everything.
struct Silhouette {
  glm::dvec3 centre;
  double radius;
};

struct SphericalPlot {
  std::vector<PlottedFunction> functions;  ///< all in one picture, hiding each other as solids do
  std::optional<Silhouette> silhouette;
  double extent = 1.2;  ///< |f| that reaches from the middle to an edge of the picture
  int size = 240;       ///< pixels a side
};

/// The picture, R,G,B, sRGB-encoded, on white: parallel projection, seen from between +x and -y, from above.
Image draw(const SphericalPlot& plot);

}  // namespace clpv
