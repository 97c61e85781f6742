// SPDX-License-Identifier: MIT
// The image codecs of the program: a module, loaded when the first image is read or written.
#include <dlfcn.h>

#include "image/codec.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr const char* kImageModule = "clpv_images.so";  // found by the program's RUNPATH

const ImageCodec* load_codec() {
  void* module = ::dlopen(kImageModule, RTLD_NOW | RTLD_LOCAL);
  void* get = module != nullptr ? ::dlsym(module, kGetImageCodec) : nullptr;
  if (get == nullptr)
    throw Error(ExitCode::run_time, "image codecs cannot be loaded: {}", ::dlerror());
  return reinterpret_cast<GetImageCodec*>(get)();
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec* const codec = load_codec();
  return *codec;
}

}  // namespace clpv
