// SPDX-License-Identifier: MIT
// In place of codec.cpp and linked_codec.cpp in a build without OpenImageIO (CLPV_IMAGES=OFF).
#include "image/codec.hpp"

namespace clpv {

const ImageCodec& image_codec() {
  return plain_codec();
}

}  // namespace clpv
