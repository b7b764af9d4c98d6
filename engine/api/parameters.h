#pragma once
/// Parameters of parts: specified once (name, unit, range, default) and validated wherever they
/// enter.
///
/// The same spec gives the JSON Schema, `vinerow list`, the loader's checks and the values a part
/// reads. File keys carry their unit as suffix (`lookahead_m`, `slope_deg`); a part converts to SI
/// and radians when it reads them.

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vinerow {

enum class ParameterKind {
  kNumber,      ///< double
  kInteger,     ///< int64
  kBoolean,     ///< bool
  kText,        ///< string, free or one of `choices`
  kPath,        ///< file or folder; relative to the file that names it, absolute after loading
  kNumberList,  ///< list of double, `size` entries if size > 0
  kTextList,    ///< list of string
  kGroup,       ///< one mapping with its own `fields`
  kGroupList,   ///< list of mappings with their own `fields`
};

/// Specification of a parameter. Parts get theirs from a ParameterTable (parameter_table.h).
struct ParameterSpec {
  std::string name;  ///< key in files, unit as suffix
  ParameterKind kind = ParameterKind::kNumber;
  std::string unit;         ///< "m", "m/s", "deg", "Hz", "" for dimensionless and non-numbers
  std::string description;  ///< one sentence
  bool required = false;    ///< no default: the user must set it
  double min = -std::numeric_limits<double>::infinity();  ///< for numbers, integers, each entry of
                                                          ///< a number list
  double max = std::numeric_limits<double>::infinity();
  bool min_exclusive = false;  ///< value > min instead of >=
  std::variant<std::monostate, double, std::int64_t, bool, std::string, std::vector<double>,
               std::vector<std::string>>
      default_value;                  ///< monostate: absent unless given (check with has())
  std::vector<std::string> choices;   ///< for texts: allowed values; empty = any
  int size = 0;                       ///< for number lists: required length; 0 = any
  std::vector<ParameterSpec> fields;  ///< for groups
  bool must_exist = true;             ///< for paths: the loader rejects a missing file or folder
  std::string former_name = {};       ///< earlier key; files may still use it, with a warning
};

/// Values that passed the checks of their specs. Reading a name or type that the spec does not have
/// is a bug in the code (VINEROW_DEMAND); setting a wrong value is a user error (ConfigError).
class ParameterSet {
 public:
  ParameterSet() = default;
  /// All defaults.
  /// @param owner  owner of the parameters, named in errors, e.g. "pure_pursuit"
  explicit ParameterSet(std::vector<ParameterSpec> specs, std::string owner = "");

  using Value = std::variant<double, std::int64_t, bool, std::string, std::vector<double>,
                             std::vector<std::string>, std::vector<ParameterSet>>;

  /// Sets one value. Integers are accepted for numbers.
  /// @throws ConfigError "lookahead_m = -1 m, must be > 0 m" | "unknown parameter 'lookahed_m' of
  /// pure_pursuit; did you mean 'lookahead_m'?" | "... must be a number, not a text" | "... is not
  /// finite"
  /// @param source  origin of the value ("data sheet p. 2", "file.yaml:12"), kept for reports
  ParameterSet& set(std::string_view name, Value value, std::string source = "");

  /// @throws ConfigError that names the first required parameter that was not given
  void require_complete() const;

  bool has(std::string_view name) const;
  /// @returns nullptr if it has no value
  const Value* find(std::string_view name) const;
  double number(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  bool boolean(std::string_view name) const;
  const std::string& text(std::string_view name) const;  ///< also paths
  const std::vector<double>& numbers(std::string_view name) const;
  const std::vector<std::string>& texts(std::string_view name) const;
  const std::vector<ParameterSet>& groups(std::string_view name) const;
  const ParameterSet& group(std::string_view name) const;  ///< @pre has(name)
  std::string source(std::string_view name) const;

  /// A new set for an entry of a group or group list; fill it and pass it to set().
  ParameterSet make_group(std::string_view name) const;

  const std::vector<ParameterSpec>& specs() const { return specs_; }
  const std::string& owner() const { return owner_; }

 private:
  struct Entry {
    Value value;
    std::string source;
  };
  const ParameterSpec& spec(std::string_view name) const;
  template <class T>
  const T& get(std::string_view name) const;

  std::vector<ParameterSpec> specs_;
  std::string owner_;
  std::map<std::string, Entry, std::less<>> values_;
};

/// Checks a value of the spec's own kind, as ParameterSet::set does.
/// @throws ConfigError "lookahead_m = -1 m, must be > 0 m"
void check_parameter(const ParameterSpec& spec, const ParameterSet::Value& value);

}  // namespace vinerow
