#include "engine/api/parameter_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {

const ParameterConversion kDegrees = {[](double value) { return rad_from_deg(value); },
                                      [](double member) { return deg_from_rad(member); }};
const ParameterConversion kInverse = {[](double value) { return 1.0 / value; },
                                      [](double member) { return 1.0 / member; }};
const ParameterConversion kCountedFromOne = {[](double value) { return value - 1.0; },
                                             [](double member) { return member + 1.0; }};

namespace parameter_rows {
namespace {

double to_member(const Row& row, double value) {
  return row.conversion.to_member ? row.conversion.to_member(value) : value;
}

/// Shortest decimal that gives the member to the last bit, so that the limits of a range pass and
/// defaults read as written: 25, not 24.999999999999996.
double to_file(const Row& row, double member) {
  if (!row.conversion.to_file) return member;
  const double plain = row.conversion.to_file(member);
  if (!std::isfinite(plain)) return plain;
  constexpr int kAllDigits = 17;
  for (int digits = 1; digits <= kAllDigits; ++digits) {
    const double rounded = std::strtod(fmt::format("{:.{}g}", plain, digits).c_str(), nullptr);
    if (row.conversion.to_member(rounded) == member) return rounded;
  }
  return plain;
}

const void* address(const void* base, std::ptrdiff_t offset) {
  return static_cast<const char*>(base) + offset;
}
void* address(void* base, std::ptrdiff_t offset) {
  return static_cast<char*>(base) + offset;
}

/// Conversion of one type of member from and to the file's value.
template <class T>
struct Cast;

template <>
struct Cast<double> {
  static double set(const Row& row, const Value& value) {
    return to_member(row, std::get<double>(value));
  }
  static Value get(const Row& row, double member) { return to_file(row, member); }
};

template <class T>
  requires std::is_integral_v<T>
struct Cast<T> {
  static T set(const Row& row, const Value& value) {
    std::int64_t whole = std::get<std::int64_t>(value);
    if (row.conversion.to_member) {
      whole = std::llround(row.conversion.to_member(static_cast<double>(whole)));
    }
    if (!std::in_range<T>(whole)) {
      throw ConfigError(
          fmt::format("{} = {}, must be {} to {}", row.spec.name, std::get<std::int64_t>(value),
                      std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
    }
    return static_cast<T>(whole);
  }
  static Value get(const Row& row, T member) {
    if (!row.conversion.to_file) return static_cast<std::int64_t>(member);
    return std::int64_t{std::llround(row.conversion.to_file(static_cast<double>(member)))};
  }
};

template <>
struct Cast<bool> {
  static bool set(const Row&, const Value& value) { return std::get<bool>(value); }
  static Value get(const Row&, bool member) { return member; }
};

template <>
struct Cast<std::string> {
  static std::string set(const Row&, const Value& value) { return std::get<std::string>(value); }
  static Value get(const Row&, const std::string& member) { return member; }
};

template <>
struct Cast<std::filesystem::path> {
  static std::filesystem::path set(const Row&, const Value& value) {
    return std::get<std::string>(value);
  }
  static Value get(const Row&, const std::filesystem::path& member) { return member.string(); }
};

template <>
struct Cast<std::vector<double>> {
  static std::vector<double> set(const Row& row, const Value& value) {
    std::vector<double> numbers = std::get<std::vector<double>>(value);
    for (double& number : numbers) number = to_member(row, number);
    return numbers;
  }
  static Value get(const Row& row, const std::vector<double>& member) {
    return get_numbers(row, member.data(), member.size());
  }
};

template <>
struct Cast<std::vector<int>> {
  static std::vector<int> set(const Row& row, const Value& value) {
    std::vector<int> numbers;
    for (const double number : std::get<std::vector<double>>(value)) {
      const double converted = to_member(row, number);
      if (converted != std::floor(converted) ||
          std::abs(converted) > std::numeric_limits<int>::max()) {
        throw ConfigError(fmt::format("{}[{}] = {}, must be a whole number", row.spec.name,
                                      numbers.size(), number));
      }
      numbers.push_back(static_cast<int>(converted));
    }
    return numbers;
  }
  static Value get(const Row& row, const std::vector<int>& member) {
    const std::vector<double> numbers(member.begin(), member.end());
    return get_numbers(row, numbers.data(), numbers.size());
  }
};

template <>
struct Cast<std::vector<std::string>> {
  static std::vector<std::string> set(const Row&, const Value& value) {
    return std::get<std::vector<std::string>>(value);
  }
  static Value get(const Row&, const std::vector<std::string>& member) { return member; }
};

template <class T>
constexpr Access kPlain = {
    [](const Row& row, const Value& value, void* member) {
      *static_cast<T*>(member) = Cast<T>::set(row, value);
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      Value value = Cast<T>::get(row, *static_cast<const T*>(member));
      const bool is_path = row.spec.kind == ParameterKind::kPath;
      if (is_path && std::get<std::string>(value).empty()) return std::nullopt;
      return value;
    }};

template <class T>
constexpr Access kPlain<std::optional<T>> = {
    [](const Row& row, const Value& value, void* member) {
      *static_cast<std::optional<T>*>(member) = Cast<T>::set(row, value);
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const auto& given = *static_cast<const std::optional<T>*>(member);
      if (!given) return std::nullopt;
      return Cast<T>::get(row, *given);
    }};

std::string place(const std::string& who, const std::string& text) {
  return who.empty() ? text : fmt::format("{}: {}", who, text);
}

/// Structs of a group or of a list of groups.
void validate_items(const Row& row, const void* member, const std::string& who) {
  const bool is_list = row.spec.kind == ParameterKind::kGroupList;
  for (std::size_t i = 0; const void* item = row.access->item(member, i); ++i) {
    const std::string name = is_list ? fmt::format("{}[{}]", row.spec.name, i) : row.spec.name;
    rows_of(row).validate(item, place(who, name));
  }
}

}  // namespace

template <class T>
const Access* access_of() {
  return &kPlain<T>;
}
#define VINEROW_ACCESS(...)                              \
  template const Access* access_of<__VA_ARGS__>();       \
  template const Access* access_of<std::optional<__VA_ARGS__>>();
VINEROW_ACCESS(double)
VINEROW_ACCESS(int)
VINEROW_ACCESS(unsigned)
VINEROW_ACCESS(std::int64_t)
VINEROW_ACCESS(std::uint64_t)
VINEROW_ACCESS(bool)
VINEROW_ACCESS(std::string)
VINEROW_ACCESS(std::filesystem::path)
VINEROW_ACCESS(std::vector<double>)
VINEROW_ACCESS(std::vector<int>)
VINEROW_ACCESS(std::vector<std::string>)
#undef VINEROW_ACCESS

const Access kScatteredNumbers = {
    [](const Row& row, const Value& value, void* member) {
      const auto& offsets = *static_cast<const std::vector<std::ptrdiff_t>*>(row.detail.get());
      const auto& numbers = std::get<std::vector<double>>(value);
      for (std::size_t i = 0; i < offsets.size(); ++i) {
        *static_cast<double*>(address(member, offsets[i])) = to_member(row, numbers[i]);
      }
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const auto& offsets = *static_cast<const std::vector<std::ptrdiff_t>*>(row.detail.get());
      std::vector<double> numbers;
      for (const std::ptrdiff_t offset : offsets) {
        numbers.push_back(to_file(row, *static_cast<const double*>(address(member, offset))));
      }
      return numbers;
    }};

void set_numbers(const Row& row, const Value& value, double* numbers, std::size_t count) {
  const auto& given = std::get<std::vector<double>>(value);
  VINEROW_DEMAND(given.size() == count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = to_member(row, given[i]);
}

Value get_numbers(const Row& row, const double* numbers, std::size_t count) {
  std::vector<double> shown(numbers, numbers + count);
  for (double& number : shown) number = to_file(row, number);
  return shown;
}

std::size_t index_of_choice(const Row& row, const Value& value) {
  const auto& choices = row.spec.choices;
  const auto found = std::find(choices.begin(), choices.end(), std::get<std::string>(value));
  VINEROW_DEMAND(found != choices.end());
  return static_cast<std::size_t>(found - choices.begin());
}

const Rows& rows_of(const Row& row) {
  return *static_cast<const Rows*>(row.detail.get());
}

const std::vector<ParameterSet>& groups_of(const Value& value) {
  return std::get<std::vector<ParameterSet>>(value);
}

Row make_row(std::string name, ParameterKind kind, std::string unit, std::string words,
             const ParameterRange& range, const ParameterConversion& conversion) {
  Row row;
  row.spec.name = std::move(name);
  row.spec.kind = kind;
  row.spec.unit = std::move(unit);
  row.spec.description = std::move(words);
  row.spec.min = range.min;
  row.spec.max = range.max;
  row.spec.min_exclusive = range.min_exclusive;
  row.conversion = conversion;
  return row;
}

void Rows::take_default(Row& row, const void* base) {
  row.spec.default_value = std::monostate{};
  const bool is_group =
      row.spec.kind == ParameterKind::kGroup || row.spec.kind == ParameterKind::kGroupList;
  if (is_group || row.spec.required) return;
  const std::optional<Value> value = row.access->get(row, address(base, row.offset));
  if (!value) return;
  std::visit(
      [&](const auto& v) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(v)>, std::vector<ParameterSet>>) {
          row.spec.default_value = v;
        }
      },
      *value);
}

void Rows::add(Row row, const void* base) {
  const bool is_new = std::none_of(rows_.begin(), rows_.end(),
                                   [&](const Row& r) { return r.spec.name == row.spec.name; });
  VINEROW_DEMAND(is_new && "a parameter table has two rows of one name");
  take_default(row, base);
  rows_.push_back(std::move(row));
}

void Rows::include(const Rows& other, std::ptrdiff_t offset, const IncludedKeys& keys,
                   const void* base) {
  const auto is_known = [&](const std::string& name) {
    return std::any_of(other.rows_.begin(), other.rows_.end(),
                       [&](const Row& row) { return row.spec.name == name; });
  };
  VINEROW_DEMAND(std::all_of(keys.only.begin(), keys.only.end(), is_known));
  for (const auto& [there, here] : keys.renamed) VINEROW_DEMAND(is_known(there));
  for (Row row : other.rows_) {
    const std::string& key = row.spec.name;
    const bool is_wanted =
        keys.only.empty() || std::find(keys.only.begin(), keys.only.end(), key) != keys.only.end();
    if (!is_wanted) continue;
    const auto renamed = std::find_if(keys.renamed.begin(), keys.renamed.end(),
                                      [&](const auto& pair) { return pair.first == key; });
    row.spec.name = renamed != keys.renamed.end() ? renamed->second : keys.prefix + key;
    row.offset += offset;
    add(std::move(row), base);
  }
  for (Rule rule : other.rules_) {
    rule.offset += offset;
    rules_.push_back(rule);
  }
}

Rows Rows::with_defaults_of(const void* base) const {
  Rows copy = *this;
  for (Row& row : copy.rows_) take_default(row, base);
  return copy;
}

Row& Rows::last() {
  VINEROW_DEMAND(!rows_.empty());
  return rows_.back();
}

Row& Rows::named(const std::string& name) {
  const auto found = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Row& row) { return row.spec.name == name; });
  VINEROW_DEMAND(found != rows_.end() && "a parameter table has no row of this name");
  return *found;
}

std::vector<ParameterSpec> Rows::specs() const {
  std::vector<ParameterSpec> specs;
  for (const Row& row : rows_) specs.push_back(row.spec);
  return specs;
}

void Rows::read(const ParameterSet& parameters, void* base, const std::string& who) const {
  for (const Row& row : rows_) {
    const Value* value = parameters.find(row.spec.name);
    if (!value) continue;
    try {
      row.access->set(row, *value, address(base, row.offset));
    } catch (const ConfigError& error) {
      throw ConfigError(place(who, error.what()));
    }
  }
}

ParameterSet Rows::write(const void* base, const std::string& owner) const {
  ParameterSet parameters(specs(), owner);
  for (const Row& row : rows_) {
    if (auto value = row.access->get(row, address(base, row.offset))) {
      parameters.set(row.spec.name, std::move(*value));
    }
  }
  return parameters;
}

void Rows::validate(const void* base, const std::string& who) const {
  for (const Row& row : rows_) {
    const void* member = address(base, row.offset);
    if (row.access->item) {
      validate_items(row, member, who);
      continue;
    }
    const std::optional<Value> value = row.access->get(row, member);
    if (!value) continue;
    try {
      check_parameter(row.spec, *value);
    } catch (const ConfigError& error) {
      throw ConfigError(place(who, error.what()));
    }
  }
  for (const Rule& rule : rules_) {
    const std::string fault = rule.call(rule.function, address(base, rule.offset));
    if (!fault.empty()) throw ConfigError(place(who, fault));
  }
}

}  // namespace parameter_rows
}  // namespace vinerow
