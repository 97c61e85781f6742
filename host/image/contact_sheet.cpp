#include "image/contact_sheet.hpp"

#include <algorithm>
#include <stdexcept>

#include "image/label.hpp"

namespace clpv {
namespace {

constexpr int kMargin = 12, kTitleSize = 20, kCaptionSize = 16;
constexpr double kLine = 1.4;  // line spacing over the text's size
constexpr glm::vec3 kInk(0.1f);

int height_of(std::size_t lines, int size) {
  return static_cast<int>(static_cast<double>(lines) * kLine * size);
}

void paste(Image& into, const Image& picture, int left, int top) {
  const auto row = static_cast<std::size_t>(picture.width) * 3;
  for (int y = 0; y < picture.height; ++y) {
    const auto from = picture.pixels.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(y));
    std::copy_n(from, row, &into.at(left, top + y, 0));
  }
}

/// Lines of text below each other, the first one's top at `top`.
void write_lines(Image& sheet, const std::vector<std::string>& lines, int x, int top, int size,
                 Anchor anchor) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int middle = top + height_of(i, size) + height_of(1, size) / 2;
    draw_label(sheet, {x, middle}, lines[i], size, kInk, anchor);
  }
}

}  // namespace

Image compose(const ContactSheet& sheet) {
  if (sheet.tiles.empty() || sheet.columns < 1) throw std::logic_error("a contact sheet without tiles");
  const Image& first = sheet.tiles.front().picture;
  std::size_t lines = 0;
  for (const Tile& tile : sheet.tiles) {
    if (tile.picture.width != first.width || tile.picture.height != first.height ||
        tile.picture.channels.size() != 3) {
      throw std::logic_error("the tiles of a contact sheet differ in size, or are not R,G,B");
    }
    lines = std::max(lines, tile.captions.size());
  }
  const int rows = (static_cast<int>(sheet.tiles.size()) + sheet.columns - 1) / sheet.columns;
  const int pitch_x = first.width + kMargin,
            pitch_y = first.height + height_of(lines, kCaptionSize) + kMargin;
  const int top = kMargin + height_of(sheet.title.size(), kTitleSize) + (sheet.title.empty() ? 0 : kMargin);
  Image result = make_image(kMargin + sheet.columns * pitch_x, top + rows * pitch_y, {"R", "G", "B"});
  std::ranges::fill(result.pixels, 1.0f);
  result.encoding = Encoding::srgb;
  write_lines(result, sheet.title, kMargin, kMargin, kTitleSize, Anchor::left);
  for (std::size_t i = 0; i < sheet.tiles.size(); ++i) {
    const int column = static_cast<int>(i) % sheet.columns, row = static_cast<int>(i) / sheet.columns;
    const int left = kMargin + column * pitch_x, y = top + row * pitch_y;
    paste(result, sheet.tiles[i].picture, left, y);
    write_lines(result, sheet.tiles[i].captions, left + first.width / 2, y + first.height, kCaptionSize,
                Anchor::centre);
  }
  return result;
}

}  // namespace clpv
