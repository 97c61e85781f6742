// SPDX-License-Identifier: MIT
// A scene of a file or of meshes in memory, its cameras and its lights.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "clpv/mesh.hpp"

namespace clpv {

/// x, y, z in world space, y up; or red, green, blue.
using Vec3 = std::array<double, 3>;

/// Perspective camera: Camera{.eye = {0, 1, 3}, .target = {0, 1, 0}}. Functions that take one throw
/// Error(usage), which names member, value found and value allowed, for numbers that are not finite
/// or out of range, an eye that is its target, and an `up` along the viewing direction.
struct Camera {
  Vec3 eye{}, target{0, 0, -1};  ///< [m], within +-1e7; only the direction of `target` matters
  Vec3 up{0, 1, 0};              ///< any length; need not be perpendicular to the viewing direction
  double vertical_fov_degrees = 60;  ///< 0.01 to 179.9
  double near = 0.05;                ///< nearest visible depth [m], 1e-6 to 1e7
  std::string name{};                ///< in the scene's list of cameras
  std::string light{};               ///< name of the only light for this camera; empty: all lights
};

/// Name of one of the scene's cameras, empty for the first; or a camera that the scene need not
/// have.
using CameraChoice = std::variant<std::string, Camera>;

enum class LightKind : unsigned { directional, spot, point };

/// Light without extent. Photometric units count 1:1 as radiometric ones: 1 lx as 1 W/m^2, 1 cd as
/// 1 W/sr. Errors as for Camera.
struct Light {
  LightKind kind = LightKind::directional;
  Vec3 position{};           ///< [m]; unused if directional
  Vec3 direction{0, -1, 0};  ///< in which light travels, of any length; unused if point
  Vec3 intensity{1, 1, 1};   ///< directional: irradiance across the direction [W/m^2]; others:
                             ///< radiant intensity [W/sr]
  double range = 0;          ///< [m], no light beyond it; 0: unlimited
  /// Spot: full light inside the inner angle, none outside the outer one; inner <= outer <= 90, 0 <
  /// outer. Equal angles give a hard edge.
  double inner_cone_degrees = 0, outer_cone_degrees = 45;
  std::string name{};
};

/// Fog or dust in a box, homogeneous. Errors as for Camera.
struct Medium {
  Vec3 scattering{}, absorption{};  ///< red, green and blue [1/m], 0 to 1e6
  /// Anisotropy of Henyey and Greenstein's phase function, -0.9 to 0.9; above 0: forwards.
  double anisotropy = 0;
  /// Lower and upper corner [m]; none: the scene's bounding box, also after its meshes change.
  std::optional<std::array<Vec3, 2>> box{};
};

/// Scene of a scene file (.json), a glTF model (.gltf, .glb), or of meshes in memory. Copies share
/// the data and its changes. Thread-safe: a change waits for frames in progress, and shows in the
/// next frame of all renderers of the scene.
class Scene {
 public:
  /// A scene without meshes. Without set_cameras() and set_lights() it has a camera that frames its
  /// meshes, and a sun, as a model has.
  Scene();

  /// `model` replaces the model of the scene file; empty: no replacement. Files are untrusted:
  /// sizes are checked before allocation, and only files in the folders of model and scene file are
  /// read. Throws Error(bad_input) with file, place, value found and value allowed.
  explicit Scene(const std::filesystem::path& path, const std::filesystem::path& model = {});

  /// Cameras (at least one) and lights as they were set, or those of the file, at 0 s if they are
  /// animated.
  std::vector<Camera> cameras() const;
  std::vector<Light> lights() const;

  /// Replace all cameras or all lights; they are then no longer animated. To change or add one,
  /// change the list of cameras() or lights(). Frames recompute only what depends on a changed
  /// light. If the scene lacks the light that Camera::light names, all lights light that camera.
  /// Throw Error(usage): see Camera and Light; no camera, more than 1024 cameras or 64 lights, two
  /// of one name.
  void set_cameras(const std::vector<Camera>& cameras);
  void set_lights(const std::vector<Light>& lights);

  /// The medium as it was set, or as the file has it, or none. After a change, the next frame of
  /// each renderer allocates its memory again. Throws Error(usage): see Medium.
  std::optional<Medium> medium() const;
  void set_medium(const std::optional<Medium>& medium);

  /// Replace the sky: radiance [W/m^2/sr] above and below the horizon, all zero for no sky; or an
  /// equirectangular map (.exr, .hdr) whose top row is at +y and whose centre at -z, times `scale`
  /// and turned towards +x. Lights stay, also the sun that a scene without lights gets. After a
  /// change, the next frame of each renderer allocates its memory again. Throw Error: usage
  /// (numbers below 0, above 1e10 or not finite), bad_input (the map).
  void set_sky(const Vec3& above, const Vec3& below = {});
  void set_sky_map(const std::filesystem::path& map, double scale = 1, double degrees = 0);

  /// Adds a mesh at a place in the world, and returns a number for it that is not used again.
  /// Throws Error(bad_input) that names array, index, value found and value allowed, for indices
  /// out of range, numbers that are not finite or out of bounds, arrays of vertices that differ in
  /// length, and more than 2^24 vertices or triangles in the scene; Error(usage) if `mesh` is not
  /// the number of a mesh.
  int add_mesh(const Mesh& mesh, const Transform& transform = kIdentity);
  /// Adds the same mesh at another place; its vertices are shared.
  int add_instance(int mesh, const Transform& transform);
  void remove_mesh(int mesh);

  /// set_positions() moves the vertices of a mesh in all its instances; set_transform() moves one
  /// instance. Without `normals`, the mesh keeps the normals it was added with. The next frame of
  /// each renderer recomputes what animation recomputes; at the first move of a mesh without
  /// Mesh::moves, and after an addition or removal, also its memory and what it caches. Throw as
  /// add_mesh().
  void set_positions(int mesh, std::span<const std::array<float, 3>> positions,
                     std::span<const std::array<float, 3>> normals = {});
  void set_transform(int mesh, const Transform& transform);

  /// Writes meshes, materials, cameras and lights at 0 s to a .glb. Logs a warning for what glTF
  /// has not: sky, medium, a camera's only light, number and size of cascades, exposure, and that a
  /// scene is dark. Lights and cameras without a name get one when it is read. Throws Error: usage
  /// (another extension), run_time (the file cannot be written).
  void save(const std::filesystem::path& path) const;

  bool moves() const;                      ///< returns true if anything in it is animated
  std::vector<std::string> notes() const;  ///< one sentence for each thing that the loader skipped
                                           ///< or added and the caller has not replaced
  std::array<Vec3, 2> bounds() const;     ///< lower and upper corner of the bounding box at 0 s [m]
  std::optional<float> exposure() const;  ///< the scene file's [EV], for save_image()

  // Copies, also where a move would do: no Scene is ever empty.
  Scene(const Scene&) = default;
  Scene& operator=(const Scene&) = default;

  struct Contents;
  const Contents& contents() const { return *contents_; }

 private:
  std::shared_ptr<Contents> contents_;
};

}  // namespace clpv
