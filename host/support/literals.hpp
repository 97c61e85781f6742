// SPDX-License-Identifier: MIT
// Typed literals (`#define NAME VALUE`) that specialise a kernel's source.
#pragma once

#include <concepts>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace clpv {

/// Set of literals. Each name starts with CLPV_ and is defined once. Functions throw
/// Error(run_time) for another name or a second definition.
class Literals {
 public:
  Literals& flag(const std::string& name, bool value);  ///< 1 or 0
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& integer(const std::string& name,
                                                     T value) {  ///< int: "3"
    return define(name, std::to_string(value));
  }
  template <std::integral T>
  requires(!std::same_as<T, bool>) Literals& number(const std::string& name,
                                                    T value) {  ///< uint: "3u"
    return define(name, std::to_string(value) + "u");
  }
  Literals& real(const std::string& name, double value);  ///< float: float_literal()
  Literals& word(const std::string& name,
                 const std::string& word);  ///< name defined in the kernels: "CLPV_SOA"

  /// Arrays: "{1.0f, 0.0f}", "{1, 2}", and a row of numbers for each row of a matrix: "{{1.0f,
  /// 0.0f}, {0.0f, 2.0f}}". Floats below 1e-12 of the largest are rounding errors of zeros, of
  /// double sums of order 1, and become 0, so that kernels can leave out their products.
  Literals& reals(const std::string& name, std::span<const double> values);
  Literals& integers(const std::string& name, std::span<const int> values);
  template <typename Matrix>
  Literals& matrix(const std::string& name, const Matrix& matrix) {
    std::vector<std::span<const double>> rows;
    for (int r = 0; r < matrix.rows(); ++r) rows.push_back(matrix.row(r));
    return table(name, rows);
  }

  Literals& add(const Literals& others);

  const std::map<std::string, std::string>& defined() const { return defined_; }

 private:
  Literals& define(const std::string& name, std::string text);
  Literals& table(const std::string& name, const std::vector<std::span<const double>>& rows);

  std::map<std::string, std::string> defined_;
};

}  // namespace clpv
