// SPDX-License-Identifier: MIT
#include "verify/expected.hpp"

#include <algorithm>
#include <cmath>

#include "basis/matrix.hpp"
#include "verify/comparison.hpp"

namespace clpv::verify {
namespace {

constexpr double kUndetermined = 1e-3;  // share of a coefficient that the directions do not see
constexpr double kRidge = 1e-9;         // keeps a matrix of rank less than full invertible

Ranges ranges_within(std::span<const double> expected, double tolerance) {
  Ranges ranges;
  for (const double value : expected)
    ranges.push_back(std::isnan(value) ? Range{} : Range{value - tolerance, value + tolerance});
  return ranges;
}

/// Largest error of each coefficient, for errors of functions of at most 1 in all directions.
std::vector<double> coefficient_errors(const std::vector<std::vector<double>>& rows) {
  const int n = rows.front().size(), m = rows.size();
  Matrix b(m, n);
  for (int i = 0; i < m; ++i) std::ranges::copy(rows[i], b.row(i).begin());
  Matrix normal = transposed(b) * b;
  double trace = 0;
  for (int i = 0; i < n; ++i) trace += normal(i, i);
  for (int i = 0; i < n; ++i) normal(i, i) += kRidge * trace;
  const Matrix solve = inverse(normal) * transposed(b), seen = solve * b;
  std::vector<double> errors;
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (const double factor : solve.row(i)) sum += std::abs(factor);
    errors.push_back(std::abs(seen(i, i) - 1) < kUndetermined ? sum : HUGE_VAL);
  }
  return errors;
}

/// Four numbers of each pixel, the last of any value.
void expect_field(Session& session, const Buffer& buffer, const std::vector<glm::vec4>& field,
                  const std::vector<bool>& uncertain, double allowed) {
  if (field.empty()) return;
  std::vector<double> expected;
  for (std::size_t i = 0; i < field.size(); ++i)
    for (int k = 0; k < 4; ++k)
      expected.push_back(uncertain[i] || k == 3 ? NAN : double{field[i][k]});
  session.recorder()->expect(buffer.handle(), "float", ranges_about(expected, allowed));
}

}  // namespace

Ranges ranges_about(std::span<const double> expected, double allowed) {
  double largest = 0;
  for (const double value : expected)
    if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
  return ranges_within(expected, allowed * largest);
}

void expect(Session& session, const Volume& volume, const Ranges& ranges) {
  if (session.recorder() == nullptr) return;
  const VolumeFormat& format = volume.format();
  const VolumeShape& shape = volume.shape();
  Ranges stored(stored_numbers(format, shape));
  std::size_t host = 0;
  for (int channel = 0; channel < shape.channels; ++channel)
    for (int i = 0; i < shape.coefficients; ++i)
      for (int cell = 0; cell < shape.n * shape.n * shape.n; ++cell)
        stored[stored_index(format, shape, channel, i, cell % shape.n, cell / shape.n % shape.n,
                            cell / shape.n / shape.n)] = ranges[host++];
  session.recorder()->expect(volume.memory(), format.storage == Storage::float16 ? "half" : "float",
                             stored);
}

void expect_pixels(Session& session, const Buffer& pixels, std::span<const double> expected,
                   double allowed, std::size_t every) {
  if (session.recorder() == nullptr) return;
  const Ranges compared = ranges_about(expected, allowed);
  Ranges all(pixels.bytes() / sizeof(float));
  for (std::size_t i = 0; i < compared.size(); ++i) all[i / 4 * every * 4 + i % 4] = compared[i];
  session.recorder()->expect(pixels.handle(), "float", all);
}

void expect_functions(Session& session, const Volume& volume, std::span<const double> expected,
                      std::span<const double> other,
                      const std::function<std::vector<double>(const glm::dvec3&)>& weights,
                      double allowed) {
  if (session.recorder() == nullptr) return;
  const std::size_t n = volume.shape().n, samples = n * n * n, size = volume.shape().coefficients;
  std::vector<std::vector<double>> rows;
  for (const glm::dvec3& w : compared_directions()) rows.push_back(weights(w));
  double largest = 0;
  for (const std::vector<double>& b : rows) {
    for (std::size_t at = 0; at < expected.size() / size; ++at) {
      double value = 0;
      for (std::size_t i = 0; i < size; ++i)
        value += b[i] * expected[(at / samples * size + i) * samples + at % samples];
      largest = std::max(largest, std::abs(value));
    }
  }
  const std::vector<double> errors = coefficient_errors(rows);
  Ranges ranges;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double error = allowed * largest * errors[i / samples % size];
    ranges.push_back(
        {std::min(expected[i], other[i]) - error, std::max(expected[i], other[i]) + error});
  }
  expect(session, volume, ranges);
}

void expect_depths(Session& session, const Buffer& buffer, const std::vector<float>& expected,
                   const std::vector<bool>& uncertain, double allowed) {
  if (session.recorder() == nullptr) return;
  std::vector<double> depths;
  for (std::size_t i = 0; i < expected.size(); ++i)
    depths.push_back(uncertain[i] ? NAN : double{expected[i]});
  const double deepest = std::max(1.0f, std::ranges::max(expected));
  session.recorder()->expect(buffer.handle(), "float", ranges_within(depths, allowed * deepest));
}

void expect_surface(Session& session, const Surface& surface, const SurfaceImage& expected,
                    const std::vector<bool>& uncertain, double allowed) {
  if (session.recorder() == nullptr) return;
  expect_depths(session, surface.depth, expected.depth, uncertain, allowed);
  expect_field(session, surface.normal, expected.normal, uncertain, allowed);
  expect_field(session, surface.colour, expected.colour, uncertain, allowed);
  if (surface.emissive.exists())
    expect_field(session, surface.emissive, expected.emissive, uncertain, allowed);
}

}  // namespace clpv::verify
