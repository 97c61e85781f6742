// SPDX-License-Identifier: MIT
#include "pipeline/inject/lookup_table.hpp"

#include <cmath>
#include <span>

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

/// Lower triangle L of the Gram matrix A = L L^T.
Matrix cholesky(const Matrix& a) {
  Matrix lower(a.rows(), a.rows());
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= lower(i, k) * lower(j, k);
      lower(i, j) = i == j ? std::sqrt(sum) : sum / lower(j, j);
    }
  }
  return lower;
}

}  // namespace

std::vector<int> parts_of(const Parameters& parameters) {
  return {parameters.index.begin(), parameters.index.end()};
}

LookupTable::LookupTable(Session& session, const Basis& basis, const LobeOptions& options,
                         TableStorage storage, TableUse use)
    : values_(table_of(basis, options, use)),
      function_parts_(parts_of(function_parameters(basis))),
      size_(options.table_size),
      storage_(storage) {
  if (!values_) return;
  if (storage == TableStorage::image) {
    require_image(session.device(), values_->size());
    image_ = session.table_image(*values_, "look-up table");
  } else {
    buffer_ = session.upload(*values_, "look-up table");
  }
}

void LookupTable::add_literals(Literals& literals) const {
  if (!values_) return;
  literals.flag("CLPV_TABLE_IMAGE", storage_ == TableStorage::image)
      .integer("CLPV_TABLE_SIZE", size_)
      .integers("CLPV_POISSON_PARTS", function_parts_);
}

void LookupTable::add_to(Kernel& kernel) const {
  if (!values_) return;
  if (storage_ == TableStorage::image) {
    kernel.add(image_);
  } else {
    kernel.add(buffer_);
  }
}

Literals lobe_literals(const Basis& basis, const LobeOptions& lobes) {
  // The flux of c = A^-1 alpha is integrals . A^-1 alpha, and A is symmetric.
  const std::vector<double> flux =
      basis.gram_inverse() * std::span<const double>(basis.integrals());
  const Matrix lower = cholesky(basis.gram());
  std::vector<double> inverse_diagonal;
  for (int i = 0; i < lower.rows(); ++i) inverse_diagonal.push_back(1 / lower(i, i));
  const bool rotated = lobes.kind == LobeKind::rotate && !basis.centres().empty();
  Literals literals;
  basis.add_literals(literals);
  literals.reals("CLPV_FLUX_WEIGHTS", flux)
      .matrix("CLPV_GRAM_LOWER", lower)
      .reals("CLPV_GRAM_INVERSE_DIAGONAL", inverse_diagonal)
      .flag("CLPV_ROTATED", rotated);
  if (rotated) {
    literals.reals("CLPV_UP_LOBE", basis.clamped_cosine({0, 0, 1}))
        .integers("CLPV_SINGULAR_PARTS", parts_of(gram_parameters(basis)));
  }
  return literals;
}

}  // namespace clpv
