// SPDX-License-Identifier: MIT
#include "codegen/linear_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/text.hpp"

namespace clpv {
namespace {

constexpr double kZero = 1e-12;  // relative to the largest entry: rounding of double sums of order 1

/// Sums and differences of inputs, one row each with entries -1, 0, 1; rows are orthogonal.
Matrix mirrored_coordinates(int inputs, const std::vector<SignedPermutation>& mirrors) {
  Matrix coordinates = Matrix::identity(inputs);
  for (const SignedPermutation& m : mirrors) {
    if (!m.exists()) continue;
    Matrix next(inputs, inputs);
    std::vector<bool> done(static_cast<std::size_t>(inputs), false);
    int out = 0;
    for (int r = 0; r < inputs; ++r) {
      if (done[r]) continue;
      // The mirror image of a coordinate is plus or minus itself or another coordinate.
      std::vector<double> image(static_cast<std::size_t>(inputs), 0.0);
      for (int i = 0; i < inputs; ++i) image[m.target[i]] += m.sign[i] * coordinates(r, i);
      int partner = -1, sign = 0;
      for (int q = r; q < inputs && partner < 0; ++q) {
        for (const int s : {1, -1}) {
          bool equal = true;
          for (int i = 0; i < inputs && equal; ++i) equal = image[i] == s * coordinates(q, i);
          if (equal) partner = q, sign = s;
          if (equal) break;
        }
      }
      done[r] = true;
      if (partner == r) {
        for (int i = 0; i < inputs; ++i) next(out, i) = coordinates(r, i);
        ++out;
        continue;
      }
      done[partner] = true;
      for (int i = 0; i < inputs; ++i) {
        next(out, i) = coordinates(r, i) + sign * coordinates(partner, i);
        next(out + 1, i) = coordinates(r, i) - sign * coordinates(partner, i);
      }
      out += 2;
    }
    coordinates = next;
  }
  return coordinates;
}

/// Parity class of a coordinate: bit i is set if mirror i changes its sign.
int parity_class(std::span<const double> coordinate, const std::vector<SignedPermutation>& mirrors) {
  int bits = 0;
  for (std::size_t b = 0; b < mirrors.size(); ++b) {
    if (!mirrors[b].exists()) continue;
    for (std::size_t i = 0; i < coordinate.size(); ++i) {
      if (coordinate[i] == 0) continue;
      const double image = mirrors[b].sign[i] * coordinate[i];
      if (image != coordinate[mirrors[b].target[i]]) bits |= 1 << b;
      break;
    }
  }
  return bits;
}

}  // namespace

std::string LinearCode::name(const std::string& expression, const OperationCount& cost) {
  const auto [entry, fresh] = names_.emplace(expression, fmt::format("v{}", names_.size()));
  if (fresh) {
    text_ += fmt::format("  const realW {} = {};\n", entry->second, expression);
    operations_.additions += cost.additions;
    operations_.multiplications += cost.multiplications;
    operations_.fused += cost.fused;
  }
  return entry->second;
}

std::string LinearCode::add(const std::string& a, const std::string& b) {
  if (a == "0.0f") return b;
  if (b == "0.0f") return a;
  return name(fmt::format("{} + {}", std::min(a, b), std::max(a, b)), {.additions = 1});
}

std::string LinearCode::subtract(const std::string& a, const std::string& b) {
  if (b == "0.0f") return a;
  return name(fmt::format("{} - {}", a, b), {.additions = 1});
}

std::string LinearCode::combination(const std::vector<Term>& terms) {
  std::string sum;
  for (const Term& term : terms) {
    const std::string factor = float_literal(term.factor);
    sum = sum.empty()
              ? name(fmt::format("{} * {}", factor, term.input), {.multiplications = 1})
              : name(fmt::format("fma((realW)({}), {}, {})", factor, term.input, sum), {.fused = 1});
  }
  return sum;
}

std::vector<std::string> LinearCode::product(const Matrix& rows, const std::vector<std::string>& inputs,
                                             const std::vector<SignedPermutation>& mirrors) {
  const int n = rows.columns();
  const Matrix coordinates = mirrored_coordinates(n, mirrors);
  double largest = 0;
  for (int r = 0; r < rows.rows(); ++r) {
    for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(rows(r, i)));
  }

  // Each row in mirrored coordinates, and the coordinates that any row needs.
  Matrix factors(rows.rows(), n);
  std::vector<bool> needed(static_cast<std::size_t>(n), false);
  for (int r = 0; r < rows.rows(); ++r) {
    for (int t = 0; t < n; ++t) {
      double along = 0, length = 0;
      for (int i = 0; i < n; ++i) {
        along += rows(r, i) * coordinates(t, i);
        length += coordinates(t, i) * coordinates(t, i);
      }
      factors(r, t) = std::abs(along / length) > kZero * largest ? along / length : 0.0;
      if (factors(r, t) != 0) needed[t] = true;
    }
  }

  // A coordinate as nested sums and differences; shared halves are named once.
  const auto coordinate_name = [&](int t) {
    std::vector<std::pair<double, std::string>> parts;
    for (int i = 0; i < n; ++i) {
      if (coordinates(t, i) != 0) parts.emplace_back(coordinates(t, i), inputs[i]);
    }
    while (parts.size() > 1) {
      std::vector<std::pair<double, std::string>> halved;
      for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
        const auto& [sa, a] = parts[i];
        const auto& [sb, b] = parts[i + 1];
        halved.emplace_back(sa, sa == sb ? add(a, b) : subtract(a, b));
      }
      if (parts.size() % 2 == 1) halved.push_back(parts.back());
      parts = std::move(halved);
    }
    return parts.front();
  };
  std::vector<std::pair<double, std::string>> names(static_cast<std::size_t>(n));
  std::vector<int> classes(static_cast<std::size_t>(n), 0);
  for (int t = 0; t < n; ++t) {
    if (needed[t]) names[t] = coordinate_name(t);
    classes[t] = parity_class(coordinates.row(t), mirrors);
  }

  // A row is a sum over parity classes; rows that mirror each other share the sum of each class up to its sign.
  std::vector<std::string> outputs;
  for (int r = 0; r < rows.rows(); ++r) {
    std::string row;
    for (int c = 0; c < (1 << mirrors.size()); ++c) {
      std::vector<Term> terms;
      for (int t = 0; t < n; ++t) {
        if (classes[t] == c && factors(r, t) != 0)
          terms.push_back({factors(r, t) * names[t].first, names[t].second});
      }
      if (terms.empty()) continue;
      const bool negative = terms.front().factor < 0;
      if (negative) {
        for (Term& term : terms) term.factor = -term.factor;
      }
      const std::string part = combination(terms);
      if (row.empty()) {
        row = negative ? name("-" + part, {}) : part;
      } else {
        row = negative ? subtract(row, part) : add(row, part);
      }
    }
    outputs.push_back(row.empty() ? "0.0f" : row);
  }
  return outputs;
}

std::string LinearCode::function(const std::string& to, const std::string& called, const std::string& from,
                                 const Matrix& matrix, const std::vector<SignedPermutation>& mirrors) {
  const std::vector<std::string> results = product(matrix, fields("a", matrix.columns()), mirrors);
  std::string text =
      fmt::format("CLPV_INLINE {0} {1}(const {2} a) {{\n{3}  {0} r;\n", to, called, from, text_);
  for (std::size_t i = 0; i < results.size(); ++i) text += fmt::format("  r.c{} = {};\n", i, results[i]);
  return text + "  return r;\n}\n";
}

std::vector<std::string> fields(const std::string& name, int count) {
  std::vector<std::string> result;
  for (int i = 0; i < count; ++i) result.push_back(fmt::format("{}.c{}", name, i));
  return result;
}

std::string macro_text(const std::string& name, const std::string& statements) {
  std::string text = "#define " + name;
  for (const char c : statements) text += c == '\n' ? std::string(" \\\n") : std::string(1, c);
  return text + "\n\n";
}

std::string cell_macros(const std::string& type, const std::string& each, int count,
                        const std::string& number) {
  std::string list, fields;
  for (int i = 0; i < count; ++i) {
    list += fmt::format(" DO({})", i);
    fields += fmt::format("{} c{}", i == 0 ? "" : ",", i);
  }
  return fmt::format("#define CLPV_EACH_{}(DO){}\ntypedef struct {{\n  {}{};\n}} {};\n", each, list, number,
                     fields, type);
}

std::string coefficient_macros(int coefficients, const std::string& number) {
  return fmt::format("#define CLPV_N {}\ntypedef {} Coefficient;\n", coefficients, number) +
         cell_macros("Coefficients", "COEFFICIENT", coefficients, "Coefficient");
}

}  // namespace clpv
