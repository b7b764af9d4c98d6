#pragma once
/// Parameter tables: one table per parameter struct, in which each parameter is declared once.
///
/// A row binds a key with unit, range and description to a member; the default is the member's
/// initialiser. The table gives the specs (loader, JSON Schema, `vinerow list`), the reader, and
/// the check of a struct that was filled in C++:
///
///   const ParameterTable<RoverParams>& rover_table() {
///     using P = RoverParams;
///     static const ParameterTable<P> table =
///         ParameterTable<P>()
///             .number("mass_kg", "kg", &P::mass_kg, kPositive, "everything")
///             .degrees("max_tilt_deg", &P::max_tilt_rad, between(1.0, 80.0), "in flight")
///             .choice("layout", &P::layout, {{"x", Layout::kX}, {"plus", Layout::kPlus}}, "arms")
///             .number("clearance_weight", "", inside(&P::cost, &CostParams::weight), kNotNegative,
///                     "a metre at no clearance costs 1 + this")
///             .rule([](const P& p) { return p.arm_m > p.radius_m ? "" : "the rotors touch"; });
///     return table;
///   }
///   rover_table().add_to(spec);
///   const RoverParams params = rover_table().read(parameters, "rover");
///   rover_table().validate(params, "rover");
///
/// Members: double; int, std::int64_t, std::size_t; bool; std::string; std::filesystem::path;
/// std::vector of double, int or std::string; std::array and fixed Eigen vectors of double; enums.
/// A std::optional of one of these is absent unless given. Reach a nested member by inside(&P::a,
/// &A::b) or by a lambda [](P& p) -> double& {...}. Tables are made once, at load time. They
/// allocate.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow {

/// Allowed values of a number; for a list, of each of its entries.
struct ParameterRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_exclusive = false;  ///< value > min instead of >=
};
inline constexpr ParameterRange kAnyNumber{};
inline constexpr ParameterRange kPositive{.min = 0.0, .min_exclusive = true};
inline constexpr ParameterRange kNotNegative{.min = 0.0};
/// min <= value <= max
constexpr ParameterRange between(double min, double max) {
  return {min, max, false};
}
/// min < value <= max
constexpr ParameterRange above(double min, double max = std::numeric_limits<double>::infinity()) {
  return {min, max, true};
}

/// Conversion between a number in the file and in the member. Range and default are those of the
/// file. The default is the shortest decimal that gives the member's initialiser to the last bit,
/// if there is one.
struct ParameterConversion {
  double (*to_member)(double) = nullptr;  ///< nullptr: the same number
  double (*to_file)(double) = nullptr;
};
extern const ParameterConversion kDegrees;         ///< member in rad: exactly rad_from_deg(value)
extern const ParameterConversion kInverse;         ///< member = 1.0 / value
extern const ParameterConversion kCountedFromOne;  ///< member = value - 1, an index

/// A word in the file and the value that it stands for.
template <class T>
struct Choice {
  const char* name;
  T value;
};

/// Word for a value, e.g. of a std::array<Choice<Layout>, 2>. @returns "?" if the value has no word
template <class Choices, class T>
const char* name_of(const Choices& choices, const T& value) {
  for (const auto& choice : choices) {
    if (choice.value == value) return choice.name;
  }
  return "?";
}

/// Selection of rows of an included table, and their keys.
struct IncludedKeys {
  std::vector<std::string> only = {};  ///< keys of that table; empty: all
  std::string prefix = {};             ///< before each key
  std::vector<std::pair<std::string, std::string>> renamed = {};  ///< key there, key here
};

namespace parameter_rows {

struct Row;
using Value = ParameterSet::Value;

/// Access to the member of a row.
struct Access {
  /// @throws ConfigError if the member's type cannot hold the value
  void (*set)(const Row& row, const Value& value, void* member);
  /// @returns the file's value; nullopt if the parameter is absent
  std::optional<Value> (*get)(const Row& row, const void* member);
  /// For groups: the i-th struct, nullptr beyond the last. nullptr for other kinds.
  const void* (*item)(const void* member, std::size_t i) = nullptr;
};

struct Row {
  ParameterSpec spec;
  const Access* access = nullptr;
  std::ptrdiff_t offset = 0;  ///< of the member in the struct
  ParameterConversion conversion;
  std::shared_ptr<const void> detail;  ///< a choice's values, a group's Rows, a list's offsets
};

struct Rule {
  std::ptrdiff_t offset = 0;  ///< of the struct that it judges
  void (*function)() = nullptr;
  std::string (*call)(void (*function)(), const void* object) = nullptr;
};

/// Rows without the struct's type.
class Rows {
 public:
  /// @param base  the struct with its initialisers
  void add(Row row, const void* base);
  void add(const Rule& rule) { rules_.push_back(rule); }
  void include(const Rows& other, std::ptrdiff_t offset, const IncludedKeys& keys,
               const void* base);
  /// The same rows with the defaults of another instance.
  Rows with_defaults_of(const void* base) const;
  Row& last();
  Row& named(const std::string& name);

  std::vector<ParameterSpec> specs() const;
  /// @param who  prefix of the error for a value that its member cannot hold, "" for none
  void read(const ParameterSet& parameters, void* base, const std::string& who) const;
  ParameterSet write(const void* base, const std::string& owner) const;
  void validate(const void* base, const std::string& who) const;

 private:
  static void take_default(Row& row, const void* base);
  std::vector<Row> rows_;
  std::vector<Rule> rules_;
};

/// Access to a member of one of the types in the file's comment, alone or in a std::optional.
template <class T>
const Access* access_of();
extern const Access kScatteredNumbers;  ///< several doubles; detail: their offsets from the first

void set_numbers(const Row& row, const Value& value, double* numbers, std::size_t count);
Value get_numbers(const Row& row, const double* numbers, std::size_t count);
std::size_t index_of_choice(const Row& row, const Value& value);
const Rows& rows_of(const Row& row);
const std::vector<ParameterSet>& groups_of(const Value& value);
Row make_row(std::string name, ParameterKind kind, std::string unit, std::string words,
             const ParameterRange& range = {}, const ParameterConversion& conversion = {});

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;

/// std::array, Eigen::Vector3d, ...
template <class T>
inline constexpr Access kFixedNumbers = {
    [](const Row& row, const Value& value, void* member) {
      T& numbers = *static_cast<T*>(member);
      set_numbers(row, value, numbers.data(), static_cast<std::size_t>(numbers.size()));
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const T& numbers = *static_cast<const T*>(member);
      return get_numbers(row, numbers.data(), static_cast<std::size_t>(numbers.size()));
    }};
template <class T>
inline constexpr Access kFixedNumbers<std::optional<T>> = {
    [](const Row& row, const Value& value, void* member) {
      kFixedNumbers<T>.set(row, value, &static_cast<std::optional<T>*>(member)->emplace());
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const auto& numbers = *static_cast<const std::optional<T>*>(member);
      return numbers ? kFixedNumbers<T>.get(row, &*numbers) : std::nullopt;
    }};

/// detail: std::vector<T>, in the order of spec.choices
template <class T>
inline constexpr Access kChoice = {
    [](const Row& row, const Value& value, void* member) {
      const auto& values = *static_cast<const std::vector<T>*>(row.detail.get());
      *static_cast<T*>(member) = values[index_of_choice(row, value)];
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const auto& values = *static_cast<const std::vector<T>*>(row.detail.get());
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == *static_cast<const T*>(member)) return Value(row.spec.choices[i]);
      }
      if constexpr (kIsOptional<T>) {
        if (!*static_cast<const T*>(member)) return std::nullopt;
      }
      return Value(std::string("(no such value)"));
    }};

template <class T>
inline constexpr Access kGroup = {
    [](const Row& row, const Value& value, void* member) {
      if constexpr (kIsOptional<T>) {
        rows_of(row).read(groups_of(value).front(), &static_cast<T*>(member)->emplace(), "");
      } else {
        rows_of(row).read(groups_of(value).front(), member, "");
      }
    },
    [](const Row& row, const void* member) -> std::optional<Value> {
      const void* group = member;
      if constexpr (kIsOptional<T>) {
        const T& given = *static_cast<const T*>(member);
        if (!given) return std::nullopt;
        group = &*given;
      }
      return std::vector<ParameterSet>{rows_of(row).write(group, row.spec.name)};
    },
    [](const void* member, std::size_t i) -> const void* {
      if (i > 0) return nullptr;
      if constexpr (kIsOptional<T>) {
        const T& given = *static_cast<const T*>(member);
        return given ? &*given : nullptr;
      } else {
        return member;
      }
    }};

/// T: std::vector of structs
template <class T>
inline constexpr Access kGroups = {[](const Row& row, const Value& value, void* member) {
                                     T& list = *static_cast<T*>(member);
                                     list.clear();
                                     for (const ParameterSet& group : groups_of(value)) {
                                       rows_of(row).read(group, &list.emplace_back(), "");
                                     }
                                   },
                                   [](const Row& row, const void* member) -> std::optional<Value> {
                                     std::vector<ParameterSet> groups;
                                     for (const auto& item : *static_cast<const T*>(member)) {
                                       groups.push_back(rows_of(row).write(&item, row.spec.name));
                                     }
                                     return groups;
                                   },
                                   [](const void* member, std::size_t i) -> const void* {
                                     const T& list = *static_cast<const T*>(member);
                                     return i < list.size() ? &list[i] : nullptr;
                                   }};

}  // namespace parameter_rows

/// Accessor of a nested member: inside(&P::cost, &CostParams::weight), to any depth.
template <class First, class... Rest>
auto inside(First first, Rest... rest) {
  return [=](auto& object) -> auto& {
    if constexpr (sizeof...(Rest) == 0) {
      return object.*first;
    } else {
      return inside(rest...)(object.*first);
    }
  };
}

/// Parameter table of one struct. @tparam P  default-constructible
///
/// `member` below is a member pointer or a function of P& that returns a reference into it.
template <class P>
class ParameterTable {
 public:
  /// A number (double). @param unit  "m", "deg/s", "" for dimensionless
  template <class F>
  ParameterTable& number(std::string name, std::string unit, F member, const ParameterRange& range,
                         std::string words, const ParameterConversion& conversion = {}) {
    auto& place = at(member);
    return add(parameter_rows::make_row(std::move(name), ParameterKind::kNumber, std::move(unit),
                                        std::move(words), range, conversion),
               place, parameter_rows::access_of<Type<decltype(place)>>());
  }
  /// Degrees in the file, radians in the member.
  template <class F>
  ParameterTable& degrees(std::string name, F member, const ParameterRange& range,
                          std::string words) {
    return number(std::move(name), "deg", member, range, std::move(words), kDegrees);
  }
  /// An integer.
  template <class F>
  ParameterTable& integer(std::string name, F member, const ParameterRange& range,
                          std::string words, const ParameterConversion& conversion = {}) {
    auto& place = at(member);
    return add(parameter_rows::make_row(std::move(name), ParameterKind::kInteger, "",
                                        std::move(words), range, conversion),
               place, parameter_rows::access_of<Type<decltype(place)>>());
  }
  template <class F>
  ParameterTable& boolean(std::string name, F member, std::string words) {
    return plain(std::move(name), ParameterKind::kBoolean, member, std::move(words));
  }
  template <class F>
  ParameterTable& text(std::string name, F member, std::string words) {
    return plain(std::move(name), ParameterKind::kText, member, std::move(words));
  }
  template <class F>
  ParameterTable& texts(std::string name, F member, std::string words) {
    return plain(std::move(name), ParameterKind::kTextList, member, std::move(words));
  }
  /// A file or folder, std::filesystem::path or std::string; an empty path is absent.
  template <class F>
  ParameterTable& path(std::string name, F member, std::string words) {
    return plain(std::move(name), ParameterKind::kPath, member, std::move(words));
  }
  /// One of several words, which are the spec's choices: an enum, or any type that copies and
  /// compares. An empty std::optional without a word of its own is absent.
  template <class F, class T = std::remove_cvref_t<std::invoke_result_t<F, P&>>>
  ParameterTable& choice(std::string name, F member, std::initializer_list<Choice<T>> choices,
                         std::string words) {
    return choose<T>(std::move(name), member, choices, std::move(words));
  }
  /// The same with a shared list of choices, e.g. a std::array<Choice<T>, N>.
  template <class F, class Choices>
  requires requires(const Choices& c) { c.begin(); }
  ParameterTable& choice(std::string name, F member, const Choices& choices, std::string words) {
    return choose<Type<decltype(at(member))>>(std::move(name), member, choices, std::move(words));
  }
  /// A list of numbers. Its length is that of a std::array or fixed vector; for a std::vector it is
  /// `size`, 0: any.
  template <class F>
  ParameterTable& numbers(std::string name, std::string unit, F member, const ParameterRange& range,
                          std::string words, int size = 0,
                          const ParameterConversion& conversion = {}) {
    auto& place = at(member);
    using T = Type<decltype(place)>;
    parameter_rows::Row row =
        parameter_rows::make_row(std::move(name), ParameterKind::kNumberList, std::move(unit),
                                 std::move(words), range, conversion);
    row.spec.size = size;
    if constexpr (parameter_rows::kIsList<T>) {
      return add(std::move(row), place, parameter_rows::access_of<T>());
    } else if constexpr (!parameter_rows::kIsOptional<T>) {
      row.spec.size = static_cast<int>(place.size());
      return add(std::move(row), place, &parameter_rows::kFixedNumbers<T>);
    } else if constexpr (parameter_rows::kIsList<typename T::value_type>) {
      return add(std::move(row), place, parameter_rows::access_of<T>());
    } else {
      row.spec.size = static_cast<int>(typename T::value_type().size());
      return add(std::move(row), place, &parameter_rows::kFixedNumbers<T>);
    }
  }
  /// A list of numbers whose entries are separate members, e.g. minimum and maximum.
  template <class F, class... More>
  ParameterTable& members(std::string name, std::string unit, const ParameterRange& range,
                          std::string words, F first, More... more) {
    parameter_rows::Row row = parameter_rows::make_row(
        std::move(name), ParameterKind::kNumberList, std::move(unit), std::move(words), range, {});
    double& place = at(first);
    row.spec.size = 1 + static_cast<int>(sizeof...(More));
    const std::ptrdiff_t begin = offset_of(place);
    row.detail = std::make_shared<const std::vector<std::ptrdiff_t>>(
        std::vector<std::ptrdiff_t>{0, offset_of(static_cast<double&>(at(more))) - begin...});
    return add(std::move(row), place, &parameter_rows::kScatteredNumbers);
  }
  /// One mapping with a table of its own: a struct, which keeps its initialisers unless the mapping
  /// is given, or a std::optional of one.
  template <class F, class S>
  ParameterTable& group(std::string name, F member, const ParameterTable<S>& table,
                        std::string words) {
    auto& place = at(member);
    using T = Type<decltype(place)>;
    const bool is_given = !parameter_rows::kIsOptional<T>;
    return add_group(std::move(name), ParameterKind::kGroup, std::move(words), place,
                     &parameter_rows::kGroup<T>,
                     is_given ? table.rows_.with_defaults_of(&place) : table.rows_);
  }
  /// A list of mappings: a std::vector of structs.
  template <class F, class S>
  ParameterTable& groups(std::string name, F member, const ParameterTable<S>& table,
                         std::string words) {
    std::vector<S>& place = at(member);
    return add_group(std::move(name), ParameterKind::kGroupList, std::move(words), place,
                     &parameter_rows::kGroups<std::vector<S>>, table.rows_);
  }
  /// Adds the rows and rules of a member's own table to this one. Defaults are those of this
  /// struct's member.
  template <class F, class S>
  ParameterTable& include(F member, const ParameterTable<S>& table, const IncludedKeys& keys = {}) {
    S& place = at(member);
    rows_.include(table.rows_, offset_of(place), keys, &defaults_);
    return *this;
  }

  /// Makes the last row required: it has no default.
  ParameterTable& required() {
    rows_.last().spec.required = true;
    rows_.last().spec.default_value = std::monostate{};
    return *this;
  }
  /// Restricts the last row's text or texts to these words.
  ParameterTable& one_of(std::vector<std::string> choices) {
    rows_.last().spec.choices = std::move(choices);
    return *this;
  }
  /// Lets the last row's path name a file that does not exist.
  ParameterTable& may_be_missing() {
    rows_.last().spec.must_exist = false;
    return *this;
  }
  /// Accepts an earlier key for the last row in files; the loader warns.
  ParameterTable& formerly(std::string name) {
    rows_.last().spec.former_name = std::move(name);
    return *this;
  }
  /// Change the description or range of an included row.
  ParameterTable& reword(const std::string& name, std::string words) {
    rows_.named(name).spec.description = std::move(words);
    return *this;
  }
  ParameterTable& limit(const std::string& name, const ParameterRange& range) {
    ParameterSpec& spec = rows_.named(name).spec;
    spec.min = range.min, spec.max = range.max, spec.min_exclusive = range.min_exclusive;
    return *this;
  }

  /// @param judge  returns the fault as a sentence, "" if the rule holds
  ParameterTable& rule(std::string (*judge)(const P&)) {
    using parameter_rows::Rule;
    rows_.add(Rule{0, reinterpret_cast<void (*)()>(judge), [](void (*function)(), const void* p) {
                     return reinterpret_cast<std::string (*)(const P&)>(function)(
                         *static_cast<const P*>(p));
                   }});
    return *this;
  }

  /// In the order of the rows.
  std::vector<ParameterSpec> specs() const { return rows_.specs(); }
  /// Appends the parameters and the check of their rules to a PartSpec, which this table outlives.
  template <class Spec>
  void add_to(Spec& spec) const {
    for (ParameterSpec& parameter : specs()) spec.parameters.push_back(std::move(parameter));
    spec.checks.push_back(
        [this](const ParameterSet& parameters, const std::string& who) { read(parameters, who); });
  }

  /// @param parameters  with at least this table's keys
  /// @param who  prefix of errors, "" for none
  /// @throws ConfigError as validate does
  P read(const ParameterSet& parameters, const std::string& who) const {
    P params{};
    rows_.read(parameters, &params, who);
    validate(params, who);
    return params;
  }
  /// Inverse of read(): a set that holds the struct's values.
  /// @throws ConfigError for a value out of its range
  ParameterSet write(const P& params, const std::string& owner = "") const {
    return rows_.write(&params, owner);
  }
  /// Checks ranges and rules of a struct, however it was filled.
  /// @throws ConfigError "rover: mass_kg = -2 kg, must be > 0 kg"
  void validate(const P& params, const std::string& who) const { rows_.validate(&params, who); }

 private:
  template <class>
  friend class ParameterTable;
  template <class Reference>
  using Type = std::remove_cvref_t<Reference>;

  template <class F>
  auto& at(F member) {
    if constexpr (std::is_member_object_pointer_v<F>) {
      return defaults_.*member;
    } else {
      return member(defaults_);
    }
  }
  template <class T>
  std::ptrdiff_t offset_of(const T& place) const {
    return reinterpret_cast<const char*>(std::addressof(place)) -
           reinterpret_cast<const char*>(std::addressof(defaults_));
  }
  template <class T>
  ParameterTable& add(parameter_rows::Row row, const T& place,
                      const parameter_rows::Access* access) {
    row.offset = offset_of(place);
    row.access = access;
    rows_.add(std::move(row), &defaults_);
    return *this;
  }
  template <class F>
  ParameterTable& plain(std::string name, ParameterKind kind, F member, std::string words) {
    auto& place = at(member);
    return add(parameter_rows::make_row(std::move(name), kind, "", std::move(words)), place,
               parameter_rows::access_of<Type<decltype(place)>>());
  }
  template <class T, class F, class Choices>
  ParameterTable& choose(std::string name, F member, const Choices& choices, std::string words) {
    parameter_rows::Row row =
        parameter_rows::make_row(std::move(name), ParameterKind::kText, "", std::move(words));
    auto values = std::make_shared<std::vector<T>>();
    for (const auto& choice : choices) {
      row.spec.choices.emplace_back(choice.name);
      values->push_back(choice.value);
    }
    row.detail = std::move(values);
    return add(std::move(row), at(member), &parameter_rows::kChoice<T>);
  }
  template <class T>
  ParameterTable& add_group(std::string name, ParameterKind kind, std::string words, const T& place,
                            const parameter_rows::Access* access,
                            const parameter_rows::Rows& fields) {
    parameter_rows::Row row = parameter_rows::make_row(std::move(name), kind, "", std::move(words));
    row.spec.fields = fields.specs();
    row.detail = std::make_shared<const parameter_rows::Rows>(fields);
    return add(std::move(row), place, access);
  }

  P defaults_{};
  parameter_rows::Rows rows_;
};

}  // namespace vinerow
