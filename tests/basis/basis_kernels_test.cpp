// SPDX-License-Identifier: MIT
// Functions of kernels/basis/ on the device against those of host/basis/ in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "pipeline/inject/lookup_table.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sphere_quadrature.hpp"
#include "volume/volume_format.hpp"

namespace clpv::basis_kernels_test {
namespace {

using test::test_session;

// Functions, integrals and the projected lobe of each direction: 3 N numbers.
constexpr const char* kKernel =
    "#include \"basis/lobe.h\"\n"
    "__kernel void values(__global const float4* directions, __global float* out CLPV_AND_H) {\n"
    "  const int i = (int)get_global_id(0);\n"
    "  const float4 w = directions[i];\n"
    "  const Coefficients b = basis_functions(w.x, w.y, w.z);\n"
    "  const Coefficients a = cosine_integrals(w.x, w.y, w.z);\n"
    "  const Coefficients c = project_sum(lobe_integrals(w.x, w.y, w.z CLPV_PASS_H));\n"
    "  for (int k = 0; k < CLPV_N; ++k) {\n"
    "    out[(3 * i + 0) * CLPV_N + k] = b.c[k];\n"
    "    out[(3 * i + 1) * CLPV_N + k] = a.c[k];\n"
    "    out[(3 * i + 2) * CLPV_N + k] = c.c[k];\n"
    "  }\n"
    "}\n";

std::vector<float> on_device(const Basis& basis, const LobeOptions& lobes,
                             const std::vector<glm::dvec3>& directions) {
  Session& session = test_session();
  const test::TemporaryFolder folder;
  folder.write("values.cl", kKernel);
  const test::Variable kernels("CLPV_KERNEL_DIR", folder.path().string());
  const LookupTable table(session, basis, lobes, TableStorage::buffer, TableUse::lobes);
  ProgramSource source{"values.cl", lobe_literals(basis, lobes)};
  add_coefficient_literals(source.literals, basis.size(), "float");
  table.add_literals(source.literals);
  std::vector<cl_float4> packed;
  for (const glm::dvec3& w : directions) {
    const glm::vec3 narrow(w);
    packed.push_back({{narrow.x, narrow.y, narrow.z, 0}});
  }
  const std::size_t numbers = directions.size() * 3 * static_cast<std::size_t>(basis.size());
  Kernel kernel(session, source, "values");
  const Buffer in = session.upload(packed, "directions"),
               out = session.buffer(numbers * sizeof(float), "values");
  table.add_to(kernel.set(in, out));
  kernel.launch(directions.size(), 1);
  return session.read<float>(out, numbers);
}

void expect_equal(const Basis& basis, const LobeOptions& lobes, double lobe_tolerance) {
  const std::vector<glm::dvec3> directions = test::spread_axes(20);
  const std::vector<float> found = on_device(basis, lobes, directions);
  const Lobes projected(basis, lobes);
  const std::size_t n = static_cast<std::size_t>(basis.size());
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const glm::dvec3 w(glm::vec3(directions[d]));
    std::vector<double> alpha(n);
    basis.cosine_integrals(w, alpha);
    const std::vector<double> expected[] = {basis.evaluate(w), alpha, projected(w)};
    for (std::size_t part = 0; part < 3; ++part) {
      double largest = 0;
      for (const double value : expected[part]) largest = std::max(largest, std::abs(value));
      const double tolerance = part == 2 ? lobe_tolerance : 2e-6;
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_NEAR(double{found[(3 * d + part) * n + i]}, expected[part][i], tolerance * largest)
            << basis.name() << ", part " << part << ", direction " << d << ", function " << i;
      }
    }
  }
}

// A projection multiplies rounding by the condition of A.
double exact_tolerance(const Basis& basis) {
  return 1e-6 * (10 + std::sqrt(basis.condition()));
}

class BasisKernels : public ::testing::TestWithParam<std::string> {};
class LongBasisKernels : public BasisKernels {};
const auto kName = [](const auto& info) { return info.param; };
// The others differ from these by numbers only. bins96 is in neither: its kernel compiles for a
// minute.
INSTANTIATE_TEST_SUITE_P(Basis, BasisKernels,
                         ::testing::Values("sh2", "sh5", "srbf4", "srbf8v2", "bins24"), kName);
INSTANTIATE_TEST_SUITE_P(LongBasis, LongBasisKernels,
                         ::testing::Values("sh3", "sh4", "srbf6", "srbf8v1", "srbf8v3", "srbf14"),
                         kName);

void expect_equal(const std::string& name) {
  const auto basis = make_basis(name);
  expect_equal(*basis, {}, exact_tolerance(*basis));
}
TEST_P(BasisKernels, FunctionsIntegralsAndLobesAreThoseInDouble) {
  expect_equal(GetParam());
}
TEST_P(LongBasisKernels, FunctionsIntegralsAndLobesAreThoseInDouble) {
  expect_equal(GetParam());
}

// Series by Chebyshev polynomials, and of several lengths.
TEST(RadialKernels, LargeAndUnevenLambdas) {
  const auto wide = make_basis("srbf8v3", 0.8);
  expect_equal(*wide, {}, exact_tolerance(*wide));
  const auto uneven = make_basis_from_centres("uneven", make_basis("srbf4")->centres(),
                                              std::vector<double>{0.2, 0.3, 0.7, 0.25});
  expect_equal(*uneven, {}, exact_tolerance(*uneven));
}

// Rounding of an index may choose another entry; with this many, that changes little.
TEST(RadialKernels, RotatedLobes) {
  for (const char* name : {"srbf4", "srbf8v2"}) {
    const auto basis = make_basis(name);
    expect_equal(*basis, {.kind = LobeKind::rotate, .table_size = 1 << 16}, 1e-3);
  }
}

}  // namespace
}  // namespace clpv::basis_kernels_test
