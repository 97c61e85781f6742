// SPDX-License-Identifier: MIT
#include "support/json_schema.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {

using nlohmann::json;

namespace {

std::size_t list_size(const json& document, const std::string& place) {
  const json::json_pointer pointer(place);
  return document.contains(pointer) && document.at(pointer).is_array() ? document.at(pointer).size()
                                                                       : 0;
}

std::string allowed_values(const Rule& rule, std::size_t into_size) {
  if (rule.nullable) {
    Rule without = rule;
    without.nullable = false;
    return allowed_values(without, into_size) + ", or null";
  }
  switch (rule.shape) {
    case Shape::object:
      return "an object";
    case Shape::list:
      return fmt::format("an array of {} to {}", rule.minimum, rule.maximum);
    case Shape::text:
      return rule.words.empty() ? std::string("a string")
                                : fmt::format("one of {}", fmt::join(rule.words, ", "));
    case Shape::flag:
      return "true or false";
    case Shape::integer:
      return rule.choices.empty()
                 ? fmt::format("an integer from {} to {}", rule.minimum, rule.maximum)
                 : fmt::format("one of {}", fmt::join(rule.choices, ", "));
    case Shape::number:
      return fmt::format("a number from {} to {}", rule.minimum, rule.maximum);
    case Shape::vector:
      return fmt::format("an array of {} numbers from {} to {}", rule.size, rule.minimum,
                         rule.maximum);
    case Shape::index:
      return into_size == 0 ? fmt::format("none, since {} is empty", rule.into)
                            : fmt::format("an index into {}, 0 to {}", rule.into, into_size - 1);
  }
  return {};
}

bool in_range(const Rule& rule, const json& value) {
  return value.is_number() && value.get<double>() >= rule.minimum &&
         value.get<double>() <= rule.maximum;
}

bool matches(const Rule& rule, const json& value, std::size_t into_size) {
  const auto one_of = [](const auto& values, const auto& wanted) {
    return values.empty() || std::find(values.begin(), values.end(), wanted) != values.end();
  };
  if (rule.nullable && value.is_null()) return true;
  switch (rule.shape) {
    case Shape::object:
      return value.is_object();
    case Shape::list:
      return value.is_array() && value.size() >= rule.minimum && value.size() <= rule.maximum;
    case Shape::text:
      return value.is_string() && one_of(rule.words, value.get_ref<const std::string&>());
    case Shape::flag:
      return value.is_boolean();
    case Shape::integer:
      if (!value.is_number_integer()) return false;
      return rule.choices.empty() ? in_range(rule, value)
                                  : one_of(rule.choices, value.get<std::int64_t>());
    case Shape::number:
      return in_range(rule, value);
    case Shape::vector:
      return value.is_array() && value.size() == rule.size &&
             std::all_of(value.begin(), value.end(),
                         [&](const json& each) { return in_range(rule, each); });
    case Shape::index:
      return value.is_number_unsigned() && value.get<std::uint64_t>() < into_size;
  }
  return false;
}

std::vector<std::string> segments_of(const std::string& place) {
  std::vector<std::string> segments;
  for (std::size_t start = 1; start <= place.size();) {
    const std::size_t end = std::min(place.find('/', start), place.size());
    segments.push_back(place.substr(start, end - start));
    start = end + 1;
  }
  return segments;
}

/// Checks all values of a document that match one rule's place.
class Checker {
 public:
  Checker(const json& document, const Rule& rule, const std::string& file)
      : document_(document),
        rule_(rule),
        file_(file),
        segments_(segments_of(rule.place)),
        into_size_(rule.shape == Shape::index ? list_size(document, rule.into) : 0) {}

  void run() { follow(document_, 0); }

 private:
  void follow(const json& value, std::size_t level) {
    if (level == segments_.size()) return check(value);
    const std::string& segment = segments_[level];
    if (segment == "*" && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) step(value[i], level, {nullptr, i});
    } else if (segment == "*" && value.is_object()) {
      for (const auto& [key, member] : value.items()) step(member, level, {&key, 0});
    } else if (value.is_object()) {
      if (const auto member = value.find(segment); member != value.end()) {
        step(*member, level, {&segment, 0});
      } else if (rule_.required && level + 1 == segments_.size()) {
        reject(file_, pointer_to(place(), segment), "nothing", allowed_values(rule_, into_size_));
      }
    }
  }

  /// One level of a path: a key, or an index if `key` is null. Formatted only for errors, since
  /// documents are large.
  struct Step {
    const std::string* key;
    std::size_t index;
  };

  void step(const json& value, std::size_t level, Step taken) {
    steps_.push_back(taken);
    follow(value, level + 1);
    steps_.pop_back();
  }

  std::string place() const {
    std::string out;
    for (const Step& taken : steps_)
      out = pointer_to(out, taken.key ? *taken.key : std::to_string(taken.index));
    return out;
  }

  void check(const json& value) const {
    if (matches(rule_, value, into_size_)) return;
    std::string found = quoted(value);
    if (rule_.shape == Shape::vector && value.is_array() && value.size() == rule_.size) {
      const auto wrong = std::find_if_not(value.begin(), value.end(),
                                          [&](const json& v) { return in_range(rule_, v); });
      found += " with " + quoted(*wrong);
    }
    reject(file_, place(), found, allowed_values(rule_, into_size_));
  }

  const json& document_;
  const Rule& rule_;
  const std::string& file_;
  std::vector<std::string> segments_;
  std::size_t into_size_;  ///< size of the list that an index points into
  std::vector<Step> steps_;
};

/// Rejects keys of `value` without a rule. `pattern` is the value's place in rules, `place` its
/// JSON pointer.
void check_keys(const json& value, const std::string& pattern, const std::string& place,
                std::span<const Rule> rules, const std::string& file) {
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      check_keys(value[i], pattern + "/*", place + "/" + std::to_string(i), rules, file);
    }
  }
  if (!value.is_object()) return;
  std::set<std::string> allowed;
  for (const Rule& rule : rules) {
    const std::size_t slash = rule.place.rfind('/');
    if (slash != std::string::npos && rule.place.substr(0, slash) == pattern)
      allowed.insert(rule.place.substr(slash + 1));
  }
  for (const auto& [key, member] : value.items()) {
    if (!allowed.contains(key)) {
      reject(file, pointer_to(place, key.substr(0, 60)), "an unknown key",
             fmt::format("{}", fmt::join(allowed, ", ")));
    }
    check_keys(member, pattern + "/" + key, pointer_to(place, key), rules, file);
  }
}

/// Rejects JSON nested too deep or with too many values, before a parser allocates, and a key that
/// an object has twice: parsers would keep one of its values. Reads events: with a callback, the
/// parser of nlohmann 3.11 looks through all elements of a list at the end of each.
class Extent : public nlohmann::json_sax<json> {
 public:
  explicit Extent(const std::string& file) : file_(file) {}

  bool start_object(std::size_t) override {
    objects_.emplace_back();
    return enter();
  }
  bool end_object() override {
    objects_.pop_back();
    return leave();
  }
  bool key(std::string& name) override {
    if (!objects_.back().insert(name).second)
      reject(file_, {}, fmt::format("duplicate key {}", quoted(json(name))),
             "unique keys of an object");
    return true;
  }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(std::int64_t) override { return count(); }
  bool number_unsigned(std::uint64_t) override { return count(); }
  bool number_float(double, const std::string&) override { return count(); }
  bool string(std::string&) override { return count(); }
  bool binary(json::binary_t&) override { return count(); }
  /// The parser that follows says what is wrong.
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    return false;
  }

 private:
  bool enter() {
    if (++depth_ > bounds::kJsonNesting)
      reject(file_, {}, fmt::format("JSON nested more than {} deep", bounds::kJsonNesting),
             fmt::format("at most {} levels", bounds::kJsonNesting));
    return count();
  }
  bool leave() {
    --depth_;
    return true;
  }
  bool count() {
    if (++values_ > bounds::kJsonValues)
      reject(file_, {}, fmt::format("more than {} JSON values", bounds::kJsonValues),
             fmt::format("at most {}", bounds::kJsonValues));
    return true;
  }

  const std::string& file_;
  std::vector<std::set<std::string>> objects_;
  int depth_ = 0;
  std::uint64_t values_ = 0;
};

}  // namespace

void check_rules(const json& document, std::span<const Rule> rules, const std::string& file) {
  for (const Rule& rule : rules) Checker(document, rule, file).run();
}

void check_no_other_keys(const json& document, std::span<const Rule> rules,
                         const std::string& file) {
  check_keys(document, "", "", rules, file);
}

json parse_json(std::string_view text, const std::string& file) {
  if (text.size() > bounds::kJsonBytes) {
    reject(file, {}, fmt::format("{} bytes of JSON", text.size()),
           fmt::format("at most {}", bounds::kJsonBytes));
  }
  Extent extent(file);
  try {
    json::sax_parse(text, &extent);
    return json::parse(text);
  } catch (const json::exception& error) {  // its text has line, column and what was expected
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
    std::string what = error.what();
    if (const std::size_t tag = what.find("] "); what.starts_with('[') && tag != std::string::npos)
      what.erase(0, tag + 2);
    std::erase_if(what, [](unsigned char c) { return c < 0x20 && c != '\t'; });
    reject(file, {}, "invalid JSON: " + what,
           "well-formed JSON in UTF-8, numbers within double's range");
  }
}

json read_json(const std::filesystem::path& path, std::uint64_t limit) {
  const Bytes bytes = read_file(path, limit, path.string());
  return parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

std::string quoted(const json& value) {
  constexpr std::size_t kShown = 60;
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_object()) return "an object";
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() > kShown ? text.substr(0, kShown) + "..." : text;
}

std::string pointer_to(const std::string& parent, const std::string& key) {
  return (json::json_pointer(parent) / key).to_string();
}

}  // namespace clpv
