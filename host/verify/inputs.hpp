// SPDX-License-Identifier: MIT
// Random inputs for checks (surfaces, triangles, volumes), and comparison of images.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "device/session.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/raster/shade.hpp"
#include "pipeline/raster/surface.hpp"
#include "reference/gather.hpp"
#include "reference/shade.hpp"
#include "reference/volume.hpp"
#include "scene/scene.hpp"
#include "verify/job.hpp"
#include "volume/volume.hpp"

namespace clpv::verify {

/// Returns the G-buffer of a camera near the origin: random depths up to 12 m, normals, colours and
/// emission. 10 % of the pixels show no surface.
SurfaceImage random_surfaces(std::mt19937& random);

/// Compares red, green, blue and alpha of every `every`-th pixel with the CPU reference: `expected`
/// has four numbers for each. Errors are relative to the largest expected value. `width`: image
/// width, to report an error's pixel. Any value is allowed in pixels that are `uncertain`.
Deviation compare_pixels(Session& session, const Buffer& pixels, std::span<const double> expected,
                         unsigned width, double allowed, std::size_t every = 1,
                         const std::vector<bool>& uncertain = {});

/// Appends red, green and blue of `colour`, and `alpha`.
void append_pixel(std::vector<double>& values, const glm::dvec3& colour, double alpha);

/// Returns true if single and double precision may read different table entries. This concerns
/// looking up `direction`, and rotating a lobe to it or to its opposite. Returns false without a
/// table.
bool rounding_decides(const Basis& basis, const LobeOptions& options, const glm::dvec3& direction);

/// Returns triangles in and around a grid of nine cells of 0.5 m from (-2.5, 0.5, 1). Sizes range
/// from specks to far larger than the grid. One has no area, some are axis-aligned, and 1 of 3 has
/// holes.
SceneData triangle_soup();

/// Returns light in 1 of 3 cells, of either sign, as from bases with negative lobes.
std::shared_ptr<reference::Volume> random_light(const Basis& basis, int n, std::mt19937& random);

/// Returns `numbers` values in [0, 1] per corner.
std::shared_ptr<reference::Volume> random_blockers(int numbers, int n, std::mt19937& random);

/// A directional light, and a point light at a place that random surfaces have around them.
extern const ClpvLight kSun, kPoint;

/// Returns a light with its maps, whose texels have the depths [m] that `depth` returns one after
/// the other. The maps show the box of `bounds`, but for those of another height than width.
reference::MappedLight mapped_light(const ClpvLight& light, const Bounds& bounds, unsigned width,
                                    unsigned height, const std::function<float()>& depth);
inline const Bounds kWideBounds{{-30, -30, -30}, {30, 30, 30}};

/// Returns a sun in the open and one that is blocked, a point light and a spot without maps, in a
/// medium. Maps are empty or block everything, so that rounding decides no texel.
std::vector<reference::MappedLight> lights_in(const ClpvMedium& medium);

/// Returns lights with their maps on the device.
std::vector<ShadowedLight> on_device(Session& session,
                                     const std::vector<reference::MappedLight>& lights);

/// Returns a volume on the device with the same values.
Volume on_device(Session& session, const reference::Volume& from, const VolumeFormat& format);

/// Light in nested cascades, as stages read it.
struct CascadeLight {
  std::vector<ClpvGrid> grids;
  std::vector<SharedVolume> light;
  /// Result of visibility_masks() for all cascades; empty: nothing is occluded.
  std::vector<std::uint8_t> occluded;
};

/// Returns random light in `count` cascades about a point near the origin. `edge`: of the finest
/// [m]. `furnace`: with the furnace of swept light.
CascadeLight random_cascades(const Basis& basis, int count, double edge, int grid, bool furnace,
                             std::vector<std::uint8_t> occluded, std::mt19937& random);

/// Returns random occlusion: each cell is occluded from half of the points.
std::vector<std::uint8_t> random_occlusion(int cascades, int grid, std::mt19937& random);

/// The same light on the device and for the CPU reference. `from` must outlive it.
struct CascadesOnDevice {
  CascadesOnDevice(Session& session, const CascadeLight& from, const VolumeFormat& format);
  std::vector<ClpvGrid> grids;
  std::vector<Volume> stored;
  Buffer occluded;  ///< null if nothing is
  std::vector<reference::Cascade> cascades;
  /// The light that Gatherer::gather() takes; must not outlive this.
  GatheredLight gathered() const;
};

// Allowed outputs of a comparison, number by number, for the capsule that a session records.
// Without a recording these functions do nothing.

/// Returns ranges about `expected`; a NaN there allows any value. `allowed`: share of the largest
/// |expected|.
Ranges ranges_about(std::span<const double> expected, double allowed);

/// `ranges` in Volume's host order.
void expect(Session& session, const Volume& volume, const Ranges& ranges);

/// The numbers of a buffer of this `type`.
void expect(Session& session, const Buffer& buffer, const char* type, const Ranges& ranges);

/// As compare_functions(): a coefficient outside its range makes the function differ by more than
/// allowed in one of the compared directions. Coefficients that the directions do not determine may
/// have any value.
void expect_functions(Session& session, const Volume& volume, std::span<const double> expected,
                      std::span<const double> other,
                      const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                      double allowed);

/// `allowed`: share of the largest depth, at least 1 m. Pixels that are `uncertain` may have any.
void expect_depths(Session& session, const Buffer& buffer, const std::vector<float>& expected,
                   const std::vector<bool>& uncertain, double allowed);

/// Fields of the image that are empty are not compared, nor pixels that are `uncertain`. Requires
/// RsmFormat::float32. `allowed`: share of each field's largest value.
void expect_surface(Session& session, const Surface& surface, const SurfaceImage& expected,
                    const std::vector<bool>& uncertain, double allowed);

}  // namespace clpv::verify
