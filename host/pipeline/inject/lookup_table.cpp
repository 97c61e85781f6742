// SPDX-License-Identifier: MIT
#include "pipeline/inject/lookup_table.hpp"

#include "support/error.hpp"

namespace clpv {
namespace {

std::optional<std::vector<float>> table_of(const Basis& basis, const LobeOptions& options,
                                           TableUse use) {
  if (basis.centres().empty()) return std::nullopt;
  if (use == TableUse::lobes) {
    if (options.kind != LobeKind::rotate) return std::nullopt;
    return gram_tables(basis, options.table_size).values();
  }
  if (!options.table_functions) return std::nullopt;
  return function_tables(basis, options.table_size).values();
}

void require_image(const Device& device, std::size_t entries) {
  if (!device.images)
    throw Error(ExitCode::device, "evaluate image: {} has no images; allowed: exact, buffer",
                device.name);
  const std::size_t most = device.handle.getInfo<CL_DEVICE_IMAGE_MAX_BUFFER_SIZE>();
  if (entries > most) {
    throw Error(ExitCode::device, "evaluate image: {} entries; an image of a buffer on {} holds {}",
                entries, device.name, most);
  }
}

}  // namespace

LookupTable::LookupTable(Session& session, const Basis& basis, const LobeOptions& options,
                         TableStorage storage, TableUse use)
    : values_(table_of(basis, options, use)), storage_(storage) {
  if (!values_) return;
  if (storage == TableStorage::image) {
    require_image(session.device(), values_->size());
    image_ = session.table_image(*values_, "look-up table");
  } else {
    buffer_ = session.upload(*values_, "look-up table");
  }
}

std::string LookupTable::no_macros(const TableName& name) {
  return fmt::format("#define CLPV_AND_{0}\n#define CLPV_PASS_{0}\n", name.macro);
}

std::string LookupTable::macros(const TableName& name) const {
  if (!values_) return no_macros(name);
  const bool image = storage_ == TableStorage::image;
  return fmt::format(
      "#define CLPV_AND_{0} , {1} {2}\n#define CLPV_PASS_{0} , {2}\n#define CLPV_TABLE_READ(table, "
      "i) {3}\n",
      name.macro, image ? "__read_only image1d_buffer_t" : "__global const float*", name.argument,
      image ? "read_imagef(table, i).x" : "(table)[i]");
}

void LookupTable::add_to(Kernel& kernel) const {
  if (!values_) return;
  if (storage_ == TableStorage::image) {
    kernel.add(image_);
  } else {
    kernel.add(buffer_);
  }
}

}  // namespace clpv
