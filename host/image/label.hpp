// Words in pictures, through OpenImageIO and whatever plain font the system has.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace clpv {

enum class Anchor { left, centre };  ///< which point of the line of text is given

/// The fonts looked for, in that order, by the name of their file. OpenImageIO finds them in the system's folders
/// and in those of the environment variable OPENIMAGEIO_FONTS.
const std::vector<std::string>& label_fonts();
/// Whether one of them is there. Without one draw_label draws nothing; who calls it says so to the user.
bool can_draw_labels();

/// Draws one line of text `size` pixels high; `at` is on its middle height, in pixels from the top left corner.
/// Into an image of three channels, in the colour space it is in.
void draw_label(Image& image, const glm::ivec2& at, const std::string& text, int size,
                const glm::vec3& colour, Anchor anchor = Anchor::left);

}  // namespace clpv
