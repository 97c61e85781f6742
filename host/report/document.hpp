// The HTML document round a report: its style, and sliders with their script.
#pragma once

#include <string>

namespace clpv::report {

/// A whole HTML document round `body`; `title` is plain text.
std::string document(const std::string& title, const std::string& body);

/// Two images of one size, one above the other, and a slider that wipes between them. Without scripts, and in print,
/// both stand side by side. Arguments are data: URIs and plain text.
std::string wipe(const std::string& left, const std::string& left_title, const std::string& right,
                 const std::string& right_title);

}  // namespace clpv::report
