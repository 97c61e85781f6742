#include "image/spherical_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "image/label.hpp"
#include "image/tone_map.hpp"

namespace clpv {
namespace {

constexpr int kSamples = 3;                              // along each side of a pixel
constexpr int kDivisions = 56;                           // of an octahedron's edge: facets of 1.6 degrees
constexpr double kStep = 1e-4;                           // rad, of the differences that give normals
constexpr double kAxisLength = 0.86, kLabelAt = 0.94;    // of the extent
constexpr double kAxisWidth = 1.1, kOutlineWidth = 1.3;  // pixels
constexpr int kDashes = 36;
constexpr glm::vec3 kInk(0.03f);

/// Where the eye is: azimuth -55 degrees, elevation 24 degrees.
struct View {
  glm::dvec3 towards{std::cos(0.42) * std::cos(-0.96), std::cos(0.42) * std::sin(-0.96), std::sin(0.42)};
  glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), towards));
  glm::dvec3 up = glm::cross(towards, right);
  glm::dvec3 lamp = glm::normalize(towards * 0.7 + up * 0.6 - right * 0.45);
};

/// The picture at kSamples^2 samples a pixel, linear colour, with depth.
class Canvas {
 public:
  Canvas(int size, double extent)
      : side_(size * kSamples),
        scale_(side_ / 2.0 / extent),
        depth_(area(), -std::numeric_limits<double>::infinity()),
        colour_(area(), glm::vec3(1)) {}

  int side() const { return side_; }
  /// x and y in samples from the top left corner, z towards the eye in the units of f.
  glm::dvec3 project(const glm::dvec3& p) const {
    return {side_ / 2.0 + glm::dot(p, view_.right) * scale_, side_ / 2.0 - glm::dot(p, view_.up) * scale_,
            glm::dot(p, view_.towards)};
  }
  void put(int x, int y, double z, const glm::vec3& colour) {
    if (x < 0 || y < 0 || x >= side_ || y >= side_) return;
    const auto i = static_cast<std::size_t>(y) * side_ + x;
    if (z <= depth_[i]) return;
    depth_[i] = z;
    colour_[i] = colour;
  }
  /// A round dot, `width` samples wide.
  void dot(const glm::dvec3& at, double width, const glm::vec3& colour) {
    const double r = width / 2;
    for (int y = static_cast<int>(std::floor(at.y - r)); y <= at.y + r; ++y) {
      for (int x = static_cast<int>(std::floor(at.x - r)); x <= at.x + r; ++x) {
        if (std::hypot(x + 0.5 - at.x, y + 0.5 - at.y) <= r) put(x, y, at.z, colour);
      }
    }
  }
  double samples_of(double length) const { return length * scale_; }
  const View& view() const { return view_; }

  /// Means of the samples, sRGB-encoded.
  Image image() const {
    const int size = side_ / kSamples;
    Image image = make_image(size, size, {"R", "G", "B"});
    image.encoding = Encoding::srgb;
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          image.at(x / kSamples, y / kSamples, c) +=
              colour_[static_cast<std::size_t>(y) * side_ + x][static_cast<int>(c)] / (kSamples * kSamples);
        }
      }
    }
    for (float& value : image.pixels) value = srgb_encode(value);
    return image;
  }

 private:
  std::size_t area() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }

  int side_;
  double scale_;
  View view_;
  std::vector<double> depth_;
  std::vector<glm::vec3> colour_;
};

struct Vertex {
  glm::dvec3 at;  ///< projected
  glm::dvec3 normal;
  double value;  ///< f
};

/// The surface |f(w)| w in direction w. Its normal is that of the level set of |p| - |f(p / |p|)|.
Vertex vertex(const Canvas& canvas, const std::function<double(const glm::dvec3&)>& f, const glm::dvec3& w) {
  const glm::dvec3 aside = std::abs(w.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(aside, w)), v = glm::cross(w, u);
  const auto slope = [&](const glm::dvec3& t) {
    return (std::abs(f(glm::normalize(w + kStep * t))) - std::abs(f(glm::normalize(w - kStep * t)))) /
           (2 * kStep);
  };
  const double value = f(w);
  const glm::dvec3 normal = std::abs(value) * w - slope(u) * u - slope(v) * v;
  const double length = glm::length(normal);
  return {canvas.project(std::abs(value) * w), length > 0 ? normal / length : w, value};
}

glm::vec3 lit(const glm::vec3& colour, glm::dvec3 normal, const View& view) {
  if (glm::dot(normal, view.towards) < 0) normal = -normal;
  const double diffuse = std::max(0.0, glm::dot(normal, view.lamp));
  const glm::dvec3 half = glm::normalize(view.lamp + view.towards);
  const double gloss = 0.18 * std::pow(std::max(0.0, glm::dot(normal, half)), 40.0);
  return glm::min(colour * static_cast<float>(0.22 + 0.95 * diffuse) + glm::vec3(static_cast<float>(gloss)),
                  glm::vec3(1));
}

void fill(Canvas& canvas, const std::array<Vertex, 3>& t, const PlottedFunction& function) {
  const glm::dvec2 a(t[0].at), b(t[1].at), c(t[2].at);
  const auto cross = [](const glm::dvec2& p, const glm::dvec2& q) { return p.x * q.y - p.y * q.x; };
  const double area = cross(b - a, c - a);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  for (int y = std::max(0, static_cast<int>(low.y)); y <= std::min<double>(high.y, canvas.side() - 1); ++y) {
    for (int x = std::max(0, static_cast<int>(low.x)); x <= std::min<double>(high.x, canvas.side() - 1);
         ++x) {
      const glm::dvec2 p(x + 0.5, y + 0.5);
      const glm::dvec3 k = glm::dvec3(cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p)) / area;
      if (k.x < 0 || k.y < 0 || k.z < 0) continue;
      const double value = k.x * t[0].value + k.y * t[1].value + k.z * t[2].value;
      const glm::vec3& colour = value < 0 ? function.negative : function.positive;
      canvas.put(x, y, k.x * t[0].at.z + k.y * t[1].at.z + k.z * t[2].at.z,
                 lit(colour, k.x * t[0].normal + k.y * t[1].normal + k.z * t[2].normal, canvas.view()));
    }
  }
}

/// One octant of the sphere, its triangles a regular division of an octahedron's face.
void draw_octant(Canvas& canvas, const PlottedFunction& function, const glm::dvec3& signs) {
  constexpr int n = kDivisions;
  std::vector<std::vector<Vertex>> rows(n + 1);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n - i; ++j) {
      const glm::dvec3 w = glm::normalize(signs * glm::dvec3(i, j, n - i - j));
      rows[i].push_back(vertex(canvas, function.value, w));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n - i; ++j) {
      fill(canvas, {rows[i][j], rows[i + 1][j], rows[i][j + 1]}, function);
      if (j + 1 < n - i) fill(canvas, {rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]}, function);
    }
  }
}

void draw_axes(Canvas& canvas, double extent) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 direction(0);
    direction[axis] = extent * kAxisLength;
    const int steps = canvas.side();  // closer than the dots are wide
    for (int i = -steps; i <= steps; ++i) {
      canvas.dot(canvas.project(direction * (static_cast<double>(i) / steps)), kAxisWidth * kSamples,
                 i > 0 ? kInk : glm::vec3(0.45f));
    }
  }
}

void draw_silhouette(Canvas& canvas, const Silhouette& sphere) {
  glm::dvec3 centre = canvas.project(sphere.centre);
  const double radius = canvas.samples_of(sphere.radius);
  const int steps = kDashes * canvas.side() / 10;
  for (int i = 0; i < steps; ++i) {
    if (i * 2 * kDashes / steps % 2 != 0) continue;  // a gap
    const double angle = 2 * std::numbers::pi * i / steps;
    const glm::dvec3 at(centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle), 1e9);
    canvas.dot(at, kOutlineWidth * kSamples, kInk);
  }
}

}  // namespace

Image draw(const SphericalPlot& plot) {
  Canvas canvas(plot.size, plot.extent);
  for (const PlottedFunction& function : plot.functions) {
    for (int octant = 0; octant < 8; ++octant) {
      draw_octant(canvas, function,
                  {octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0});
    }
  }
  draw_axes(canvas, plot.extent);
  if (plot.silhouette) draw_silhouette(canvas, *plot.silhouette);
  Image image = canvas.image();
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 end(0);
    end[axis] = plot.extent * kLabelAt;
    const glm::dvec3 at = canvas.project(end) / static_cast<double>(kSamples);
    draw_label(image, {static_cast<int>(at.x), static_cast<int>(at.y)}, std::string(1, "xyz"[axis]),
               std::max(8, plot.size / 16), glm::vec3(0.2f), Anchor::centre);
  }
  return image;
}

}  // namespace clpv
