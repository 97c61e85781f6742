#include "image/label.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <stdexcept>

#include "support/error.hpp"

namespace clpv {
namespace {

/// The first font there is; empty: none.
const std::string& font() {
  static const std::string found = [] {
    const auto& names = label_fonts();
    const auto usable = [](const std::string& name) {
      return OIIO::ImageBufAlgo::text_size("x", 16, name).defined();
    };
    const auto name = std::ranges::find_if(names, usable);
    OIIO::geterror();  // what was not found is no error here
    return name == names.end() ? std::string() : *name;
  }();
  return found;
}

}  // namespace

const std::vector<std::string>& label_fonts() {
  static const std::vector<std::string> names{"DejaVuSans", "LiberationSans-Regular", "NotoSans-Regular",
                                              "FreeSans", "DroidSans"};
  return names;
}

bool can_draw_labels() {
  return !font().empty();
}

void draw_label(Image& image, const glm::ivec2& at, const std::string& text, int size,
                const glm::vec3& colour, Anchor anchor) {
  if (image.channels.size() != 3) throw std::logic_error("draw_label wants three channels");
  if (!can_draw_labels() || text.empty()) return;
  using namespace OIIO::ImageBufAlgo;
  const OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeFloat);
  OIIO::ImageBuf view(spec, image.pixels.data());
  const TextAlignX align = anchor == Anchor::centre ? TextAlignX::Center : TextAlignX::Left;
  // The baseline by the height of capitals, not of this text, so that neighbours stand on one line.
  const OIIO::ROI capital = text_size("H", size, font());
  const int baseline = at.y + (capital.yend - capital.ybegin) / 2;
  if (!render_text(view, at.x, baseline, text, size, font(), {colour.r, colour.g, colour.b}, align)) {
    throw Error(ExitCode::run_time, "the label '{}' cannot be drawn: {}", text, view.geterror());
  }
}

}  // namespace clpv
