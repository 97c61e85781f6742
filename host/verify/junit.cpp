// SPDX-License-Identifier: MIT
#include "verify/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "support/text.hpp"

namespace clpv::reference {
namespace {

std::string test_case(const CheckResult& result) {
  const std::string head =
      fmt::format("    <testcase classname=\"clpv.{}\" name=\"{}\" time=\"{:.3f}\"",
                  xml_escaped(result.stage), xml_escaped(result.variant), result.seconds);
  if (result.passed()) return head + "/>\n";
  return head +
         fmt::format(">\n      <failure message=\"{:.3e} &gt; {:.0e}\">{}</failure>\n    </testcase>\n",
                     result.worst, result.allowed, xml_escaped(result.place));
}

}  // namespace

std::string junit(const CheckResults& results, const std::string& device) {
  const auto failed = [](const CheckResult& result) { return !result.passed(); };
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"clpv check on {}\" tests=\"{}\" "
      "failures=\"{}\">\n",
      xml_escaped(device), results.size(), std::ranges::count_if(results, failed));
  for (auto first = results.begin(); first != results.end();) {
    const auto last = std::find_if(first, results.end(),
                                   [&](const CheckResult& result) { return result.stage != first->stage; });
    text += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\">\n", xml_escaped(first->stage),
                        last - first, std::count_if(first, last, failed));
    for (; first != last; ++first) text += test_case(*first);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace clpv::reference
