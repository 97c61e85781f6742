// SPDX-License-Identifier: MIT
// Converts cameras, lights and media of the public interface (clpv/scene.hpp) to those of a scene
// and back. The only checks of their numbers.
#pragma once

#include <functional>
#include <string>

#include "clpv/scene.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Receives member, value found and value allowed; throws.
using RejectMember = std::function<void(const std::string& member, const std::string& found,
                                        const std::string& allowed)>;

/// Throws Error(usage): "`what`: eye: found ..., allowed: ...".
RejectMember rejected_in(const std::string& what);

/// Lengths and positions are multiplied by `metres_per_unit`.
SceneCamera scene_camera(const Camera& camera, const RejectMember& reject,
                         double metres_per_unit = 1);
SceneLight scene_light(const Light& light, const RejectMember& reject, double metres_per_unit = 1);

/// Without a box, `lower` and `upper` are equal (MovingScene::set_medium).
ClpvMedium scene_medium(const Medium& medium, const RejectMember& reject,
                        double metres_per_unit = 1);

/// Null if all is dark; and of a map, turned by `degrees`.
std::shared_ptr<const Sky> scene_sky(const Vec3& above, const Vec3& below,
                                     const RejectMember& reject);
std::shared_ptr<const Sky> scene_sky(const std::filesystem::path& map, double scale, double degrees,
                                     const RejectMember& reject);

Camera camera_of(const SceneCamera& camera);
Light light_of(const SceneLight& light);
Medium medium_of(const ClpvMedium& medium);

/// The numbers of a camera in one line, as its name in metadata and messages.
std::string text_of(const Camera& camera);

}  // namespace clpv
