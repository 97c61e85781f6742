// SPDX-License-Identifier: MIT
#include "verify/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "support/text.hpp"

namespace clpv::verify {
namespace {

std::string test_case(const CheckResult& result) {
  const std::string head =
      fmt::format("    <testcase classname=\"clpv.{}\" name=\"{}\" time=\"{:.6f}\"",
                  xml_escaped(result.stage), xml_escaped(result.variant), result.seconds);
  const auto with = [&](const std::string& element) {
    return fmt::format("{}>\n      {}\n    </testcase>\n", head, element);
  };
  switch (result.status) {
    case Status::ok:
      return head + "/>\n";
    case Status::wrong:
      return with(fmt::format("<failure message=\"{:.3e} &gt; {:.0e}\">{}</failure>",
                              result.deviation.worst, result.deviation.allowed,
                              xml_escaped(result.deviation.place)));
    case Status::failed:
      return with(fmt::format("<error>{}</error>", xml_escaped(result.reason)));
    case Status::unsupported:
      return with(fmt::format("<skipped message=\"{}\"/>", xml_escaped(result.reason)));
  }
  return {};
}

/// The counts of a suite, as attributes.
std::string counts(CheckResults::const_iterator first, CheckResults::const_iterator last) {
  const auto of = [&](Status status) {
    return std::count_if(first, last,
                         [&](const CheckResult& result) { return result.status == status; });
  };
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", last - first,
                     of(Status::wrong), of(Status::failed), of(Status::unsupported));
}

}  // namespace

std::string junit(CheckResults results, const std::string& device) {
  if (std::ranges::none_of(results, &CheckResult::passed))
    results.push_back(
        result_of("check", "at least one comparison is ok", Status::failed, "none is"));
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"clpv check on {}\" {}>\n",
      xml_escaped(device), counts(results.begin(), results.end()));
  for (auto first = results.begin(); first != results.end();) {
    const auto last = std::find_if(first, results.end(), [&](const CheckResult& result) {
      return result.stage != first->stage;
    });
    text += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_escaped(first->stage),
                        counts(first, last));
    for (; first != last; ++first) text += test_case(*first);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace clpv::verify
