// Several pictures on one sheet, in rows, each with a caption.
#pragma once

#include <string>
#include <vector>

#include "image/image.hpp"

namespace clpv {

struct Tile {
  Image picture;                      ///< R,G,B, sRGB-encoded; all of one size
  std::vector<std::string> captions;  ///< lines below it
};

struct ContactSheet {
  std::vector<std::string> title;  ///< lines above all
  int columns = 1;
  std::vector<Tile> tiles;  ///< row by row
};

/// On white, without what no font is there for (image/label.hpp).
Image compose(const ContactSheet& sheet);

}  // namespace clpv
