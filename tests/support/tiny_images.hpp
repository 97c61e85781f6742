// SPDX-License-Identifier: MIT
// Bytes as text and back, as data URIs of glTF hold them; and encoded images of a few pixels.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tinygltf {
std::string base64_encode(const unsigned char* bytes, unsigned int count);
std::string base64_decode(const std::string& text);
}  // namespace tinygltf

namespace clpv::test {

inline std::string encode_base64(std::string_view bytes) {
  return tinygltf::base64_encode(reinterpret_cast<const unsigned char*>(bytes.data()),
                                 static_cast<unsigned>(bytes.size()));
}

inline std::string decode_base64(std::string_view text) {
  return tinygltf::base64_decode(std::string(text));
}

/// Rows: red, half-transparent green; transparent blue, grey 128.
inline constexpr std::string_view kPngRgba2x2 =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAFklEQVR42mP4z8DwHwgbGEB0Q0PDfwA7YAb8UNK/"
    "lAAAAABJRU5ErkJggg==";

/// One grey pixel of 77.
inline constexpr std::string_view kPngGrey =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mPwBQAATwBOxAN74QAAAABJRU5ErkJggg==";

/// One 16-bit grey pixel of 0x4d4d: 77 in 8 bits.
inline constexpr std::string_view kPngGrey16 =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABEAAAAABq7kcWAAAAC0lEQVR42mPw9QUAAOoAm19doCgAAAAASUVORK5CYII=";

/// One palette pixel (10, 20, 30).
inline constexpr std::string_view kPngPalette =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAMAAAAoyzS7AAAABlBMVEUJCQkKFB4rRqocAAAACklEQVR42mNgBAAAAwAC5n"
    "2nZwAAAABJRU5ErkJggg==";

/// 64 red pixels.
inline constexpr std::string_view kJpegRed8x8 =
    "/9j/"
    "2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeXBkeFxlZ2P/"
    "2wBDARESEhgVGC8aGi9jQjhCY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2P/"
    "wAARCAAIAAgDASIAAhEBAxEB/8QAHwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/"
    "8QAtRAAAgEDAwIEAwUFBAQAAAF9AQIDAAQRBRIhMUEGE1FhByJxFDKBkaEII0KxwRVS0fAkM2JyggkKFhcYGRolJicoKSo"
    "0NTY3ODk6Q0RFRkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t"
    "7i5usLDxMXGx8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/"
    "8QAHwEAAwEBAQEBAQEBAQAAAAAAAAECAwQFBgcICQoL/"
    "8QAtREAAgECBAQDBAcFBAQAAQJ3AAECAxEEBSExBhJBUQdhcRMiMoEIFEKRobHBCSMzUvAVYnLRChYkNOEl8RcYGRomJyg"
    "pKjU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6goOEhYaHiImKkpOUlZaXmJmaoqOkpaanqKmqsrO0t"
    "ba3uLm6wsPExcbHyMnK0tPU1dbX2Nna4uPk5ebn6Onq8vP09fb3+Pn6/9oADAMBAAIRAxEAPwDFoooryz7w/9k=";

/// 64 pixels of CMYK (0, 179, 217, 55 of 255), inverted as Adobe does: RGB (200, 60, 30).
inline constexpr std::string_view kJpegCmyk8x8 =
    "/9j/7gAOQWRvYmUAZAAAAAAA/9sAQwADAgIDAgIDAwMDBAMDBAUIBQUEBAUKBwcGCAwKDAwLCgsLDQ4SEA0OEQ4LCx"
    "AWEBETFBUVFQwPFxgWFBgSFBUU/8AAFAgACAAIBEMRAE0RAFkRAEsRAP/EABUAAQEAAAAAAAAAAAAAAAAAAAgJ/8QA"
    "FBABAAAAAAAAAAAAAAAAAAAAAP/aAA4EQwBNAFkASwAAPwBgCUn0qm//2Q==";

/// 16 x 8 pixels, green on the left as stored; its Exif orientation 2 says mirrored.
inline constexpr std::string_view kJpegExif16x8 =
    "/9j/4AAQSkZJRgABAQAAAQABAAD/4QAiRXhpZgAATU0AKgAAAAgAAQESAAMAAAABAAIAAAAAAAD/2wBDAAMCAgMCAg"
    "MDAwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEBYQERMUFRUVDA8XGBYUGBIUFRT/2wBDAQMEBAUE"
    "BQkFBQkUDQsNFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBT/wAARCAAIAB"
    "ADAREAAhEBAxEB/8QAFQABAQAAAAAAAAAAAAAAAAAABAf/xAAUEAEAAAAAAAAAAAAAAAAAAAAA/8QAFgEBAQEAAAAA"
    "AAAAAAAAAAAACAYJ/8QAFBEBAAAAAAAAAAAAAAAAAAAAAP/aAAwDAQACEQMRAD8AIOQTp0pWzD//2Q==";

/// The pixels of kPngRgba2x2, but alpha 10 of the blue one; lossless.
inline constexpr std::string_view kWebpRgba2x2 =
    "UklGRjoAAABXRUJQVlA4TC4AAAAvAUAAEB8gEEhSn3wNgQDBuXMCAYJz54QExAB/VdOFmTNaBTVtG7D4TToi+h8c";
/// 4 x 4 pixels of (200, 100, 50), lossy; and the same of alpha 128.
inline constexpr std::string_view kWebpLossy =
    "UklGRj4AAABXRUJQVlA4IDIAAADQAQCdASoEAAQAAMASJaACdLoB+AADsAD+2ib/7vN+09e09f1M//jKnyA/4yp/xcwA"
    "AA==";
inline constexpr std::string_view kWebpLossyAlpha =
    "UklGRmIAAABXRUJQVlA4WAoAAAAQAAAAAwAAAwAAQUxQSAoAAAABB1DAiAhERP8DVlA4IDIAAADQAQCdASoEAAQAAMAS"
    "JaACdLoB+AADsAD+2ib/7vN+09e09f1M//jKnyA/4yp/xcwAAA==";

}  // namespace clpv::test
