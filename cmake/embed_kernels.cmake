# SPDX-License-Identifier: MIT
# cmake -DROOT=kernels -DOUTPUT=file.cpp -P embed_kernels.cmake
# Bytes, not raw strings: a kernel file stays an ordinary file, of any length and with any characters.
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/*.cl ${ROOT}/*.h)
list(SORT files)
set(arrays "")
set(table "")
set(index 0)
foreach(name IN LISTS files)
  file(READ ${ROOT}/${name} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND arrays "const unsigned char file_${index}[] = {${bytes}0x00};\n")
  string(APPEND table "    {\"${name}\", {reinterpret_cast<const char*>(file_${index}), sizeof(file_${index}) - 1}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE ${OUTPUT}
"// Made by cmake/embed_kernels.cmake from kernels/.
#include \"device/kernel_files.hpp\"

namespace clpv::detail {
namespace {
${arrays}}  // namespace

const std::map<std::string, std::string_view>& embedded_kernel_files() {
  static const std::map<std::string, std::string_view> files = {
${table}  };
  return files;
}
}  // namespace clpv::detail
")
