// Reading, printing and saving the settings of a Push interpreter.
#include "runtime/learn/push/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "runtime/learn/push/code.hpp"
#include "runtime/learn/push/instructions.hpp"

namespace breve::push {

namespace {

constexpr std::string_view kConstantNames[kConstants] = {"INTEGER.ERC", "FLOAT.ERC", "BOOLEAN.ERC", "VECTOR.ERC",
                                                         "NAME.ERC"};
constexpr double kMostInteger = std::numeric_limits<std::int32_t>::max();
constexpr double kMostFloat = 1e300;  // a range of floats has a finite width

/// A setting with a number: where it is, and what it may be.
struct Number {
  std::string_view name;
  std::int32_t Settings::*integer;
  double Settings::*real;
  double least, most;
};
constexpr Number kNumbers[] = {
    {"EVALPUSH-LIMIT", &Settings::evaluation_limit, nullptr, 0, kMostInteger},
    {"MAX-POINTS-IN-PROGRAM", &Settings::list_limit, nullptr, 1, kMaxPoints},
    {"MAX-POINTS-IN-RANDOM-EXPRESSIONS", &Settings::random_points, nullptr, 1, kMaxPoints},
    {"MAX-RANDOM-FLOAT", nullptr, &Settings::max_float, -kMostFloat, kMostFloat},
    {"MAX-RANDOM-INTEGER", &Settings::max_integer, nullptr, -kMostInteger, kMostInteger},
    {"MIN-RANDOM-FLOAT", nullptr, &Settings::min_float, -kMostFloat, kMostFloat},
    {"MIN-RANDOM-INTEGER", &Settings::min_integer, nullptr, -kMostInteger, kMostInteger},
    {"NEW-ERC-NAME-PROBABILITY", nullptr, &Settings::new_name_probability, 0, 1},
};

struct Flag {
  std::string_view name;
  bool Settings::*flag;
};
constexpr Flag kFlags[] = {
    {"TOP-LEVEL-POP-CODE", &Settings::pop_code},
    {"TOP-LEVEL-PUSH-CODE", &Settings::push_code},
};

[[noreturn]] void fail_line(std::size_t line, const std::string& what) {
  throw Error(ErrorCode::Argument, fmt::format("Push configuration, line {}: {}", line, what));
}

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSpaces = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(kSpaces), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSpaces));
  line.remove_prefix(word.size());
  return word;
}

std::string in_capitals(std::string_view word) {
  std::string capitals(word);
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return capitals;
}

/// Give a setting its value. False if there is no such setting.
bool set(Settings& settings, std::string_view name, std::string_view value, std::size_t line) {
  for (const Flag& flag : kFlags) {
    if (flag.name != name) continue;
    const std::string truth = in_capitals(value);
    if (truth != "TRUE" && truth != "FALSE") fail_line(line, fmt::format("{} must be TRUE or FALSE", name));
    settings.*flag.flag = truth == "TRUE";
    return true;
  }
  for (const Number& number : kNumbers) {
    if (number.name != name) continue;
    double read = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), read);
    const bool whole = number.integer == nullptr || read == std::floor(read);
    if (error != std::errc() || end != value.data() + value.size() || !whole || !(read >= number.least) ||
        !(read <= number.most))
      fail_line(line, fmt::format("{} must be {} from {} to {}", name, number.integer ? "an integer" : "a number",
                                  number.least, number.most));
    if (number.integer)
      settings.*number.integer = static_cast<std::int32_t>(read);
    else
      settings.*number.real = read;
    return true;
  }
  return false;
}

template <class T>
void insert_sorted(std::pmr::vector<T>& into, T value) {
  const auto at = std::lower_bound(into.begin(), into.end(), value);
  if (at == into.end() || *at != value) into.insert(at, value);
}

/// Activate one instruction or constant. False if there is none of this name.
bool activate(Settings& settings, std::string_view name) {
  for (std::uint8_t i = 0; i < kConstants; ++i)
    if (kConstantNames[i] == name) return insert_sorted(settings.constants, static_cast<Constant>(i)), true;
  const std::optional<std::uint16_t> number = find_instruction(name);
  if (number) insert_sorted(settings.active, *number);
  return number.has_value();
}

/// Activate all of a type: what stands before the point of an instruction's name. False if there is none.
bool activate_type(Settings& settings, std::string_view type) {
  const std::string prefix = std::string(type) + ".";
  bool found = false;
  for (std::uint16_t i = 0; i < instructions().size(); ++i)
    if (instructions()[i].name.starts_with(prefix)) found = activate(settings, instructions()[i].name);
  for (const std::string_view constant : kConstantNames)
    if (constant.starts_with(prefix)) found = activate(settings, constant);
  return found;
}

void check_ranges(const Settings& settings, std::size_t line) {
  if (settings.min_integer > settings.max_integer)
    fail_line(line, "MIN-RANDOM-INTEGER is greater than MAX-RANDOM-INTEGER");
  if (settings.min_float > settings.max_float) fail_line(line, "MIN-RANDOM-FLOAT is greater than MAX-RANDOM-FLOAT");
}

}  // namespace

std::string_view name_of(Constant constant) { return kConstantNames[static_cast<std::size_t>(constant)]; }

Settings::Settings(std::pmr::memory_resource* memory) : active(memory), constants(memory) { activate_all(); }

void Settings::activate_all() {
  for (std::uint16_t i = 0; i < instructions().size(); ++i) active.push_back(i);
  for (std::uint8_t i = 0; i < kConstants; ++i) constants.push_back(static_cast<Constant>(i));
}

void Settings::read(std::string_view text, std::pmr::string& unknown, const Poll& poll,
                    const std::function<bool(std::string_view)>& is_word) {
  constexpr std::size_t kLinesPerPoll = 256, kToldNames = 20;
  Settings made(active.get_allocator().resource());
  made = *this;
  bool names_any = false;
  std::size_t line = 0, unknown_names = 0;
  while (!text.empty()) {
    if (poll && line % kLinesPerPoll == 0) poll();
    ++line;
    const std::string_view whole = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(whole.size() + 1, text.size()));
    std::string_view rest = whole.substr(0, whole.find('#'));
    const std::string keyword = in_capitals(next_word(rest));
    if (keyword.empty()) continue;
    const std::string_view value = next_word(rest);
    if (value.empty()) fail_line(line, fmt::format("'{}' needs a value", keyword.substr(0, 40)));
    if (!next_word(rest).empty()) fail_line(line, "more than two words; a comment begins with #");
    bool known = false;
    if (keyword == "INSTRUCTION" || keyword == "TYPE") {
      if (!names_any) made.active.clear(), made.constants.clear();
      names_any = true;
      const std::string name = in_capitals(value);
      known = keyword == "TYPE" ? activate_type(made, name) : activate(made, name);
      if (!known && keyword == "INSTRUCTION") known = is_word && is_word(value);
    } else {
      known = set(made, keyword, value, line);
    }
    if (!known && ++unknown_names <= kToldNames)
      fmt::format_to(std::back_inserter(unknown), "line {}: '{}' is not known\n", line,
                     (keyword == "INSTRUCTION" || keyword == "TYPE" ? value : std::string_view(keyword)).substr(0, 80));
  }
  if (unknown_names > kToldNames)
    fmt::format_to(std::back_inserter(unknown), "and {} lines more\n", unknown_names - kToldNames);
  check_ranges(made, line);
  *this = std::move(made);
}

void Settings::print(std::pmr::string& out) const {
  const auto to = std::back_inserter(out);
  for (const Number& number : kNumbers)
    if (number.integer)
      fmt::format_to(to, "{} {}\n", number.name, this->*number.integer);
    else
      fmt::format_to(to, "{} {}\n", number.name, this->*number.real);
  for (const Flag& flag : kFlags) fmt::format_to(to, "{} {}\n", flag.name, this->*flag.flag ? "TRUE" : "FALSE");
  for (const std::uint16_t number : active) fmt::format_to(to, "instruction {}\n", instructions()[number].name);
  for (const Constant constant : constants) fmt::format_to(to, "instruction {}\n", name_of(constant));
}

void Settings::save(ByteWriter& out) const {
  for (const Number& number : kNumbers)
    if (number.integer)
      out.put(this->*number.integer);
    else
      out.put(this->*number.real);
  for (const Flag& flag : kFlags) out.put(this->*flag.flag);
  out.put(static_cast<std::uint64_t>(active.size()));
  for (const std::uint16_t number : active) out.put(number);
  out.put(static_cast<std::uint64_t>(constants.size()));
  for (const Constant constant : constants) out.put(constant);
}

void Settings::load(ByteReader& in) {
  for (const Number& number : kNumbers) {
    const double value =
        number.integer ? this->*number.integer = in.get<std::int32_t>() : this->*number.real = in.get<double>();
    if (!(value >= number.least) || !(value <= number.most)) ByteReader::fail();
  }
  for (const Flag& flag : kFlags) this->*flag.flag = in.get_bool();
  if (min_integer > max_integer || !(min_float <= max_float)) ByteReader::fail();
  active.clear();
  constants.clear();
  for (std::size_t left = in.get_count(sizeof(std::uint16_t)); left > 0; --left) {
    const auto number = in.get<std::uint16_t>();
    if (number >= instructions().size() || (!active.empty() && number <= active.back())) ByteReader::fail();
    active.push_back(number);
  }
  for (std::size_t left = in.get_count(); left > 0; --left) {
    const auto constant = in.get<std::uint8_t>();
    if (constant >= kConstants || (!constants.empty() && static_cast<Constant>(constant) <= constants.back()))
      ByteReader::fail();
    constants.push_back(static_cast<Constant>(constant));
  }
}

void Settings::hash(Hasher& hasher) const {
  for (const Number& number : kNumbers) hasher.add(number.integer ? this->*number.integer : this->*number.real);
  for (const Flag& flag : kFlags) hasher.add(static_cast<std::uint64_t>(this->*flag.flag));
  for (const std::uint16_t number : active) hasher.add(static_cast<std::uint64_t>(number));
  for (const Constant constant : constants) hasher.add(static_cast<std::uint64_t>(constant));
}

}  // namespace breve::push
