// SPDX-License-Identifier: MIT
// The linked image codecs. The linker leaves this file out of a program that defines image_codec().
#include "image/codec.hpp"

extern "C" clpv::GetImageCodec clpv_image_codec;

namespace clpv {

const ImageCodec& image_codec() {
  return *clpv_image_codec();
}

}  // namespace clpv
