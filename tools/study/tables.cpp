#include "tools/study/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/io/files/csv.h"
#include "engine/math/statistics.h"
#include "tools/study/numbers.h"
#include "tools/study/setting_numbers.h"
#include "tools/study/statistics.h"

namespace vinerow::study {
namespace {

class Row {
 public:
  Row& word(const std::string& text) { return add(io::csv_text(text)); }
  Row& number(double value) { return add(io::csv_number(value)); }
  Row& count(std::size_t value) { return add(std::to_string(value)); }
  Row& words(const std::vector<std::string>& texts) {
    for (const std::string& one : texts) word(one);
    return *this;
  }
  std::string line() const { return line_ + "\n"; }

 private:
  Row& add(const std::string& cell) {
    if (!is_first_) line_ += ',';
    is_first_ = false;
    line_ += cell;
    return *this;
  }
  std::string line_;
  bool is_first_ = true;
};

}  // namespace

std::vector<std::string> kept_numbers(const Results& results) {
  const scenario::Study& study = results.design().study();
  std::vector<std::string> names = study.metrics.empty() ? results.names() : study.metrics;
  for (const scenario::DerivedColumn& column : study.derived) names.push_back(column.name);
  return names;
}

std::string cells_csv(const Results& results) {
  const Design& design = results.design();
  const std::vector<std::string> names = kept_numbers(results);
  Numbers numbers(results);
  std::string csv = Row()
                        .words({"cell", "setting", "seed"})
                        .words(design.columns())
                        .words({"state", "reason", "digest"})
                        .words(names)
                        .line();
  std::vector<std::string> texts;
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    if (cell % design.seeds() == 0) texts = design.texts(design.setting_of(cell));
    Row row;
    row.count(cell).count(design.setting_of(cell)).count(design.seed_of(cell)).words(texts);
    row.word(to_string(results.state(cell))).word(results.reason(cell)).word(results.digest(cell));
    for (const std::string& name : names) row.number(numbers.value(cell, name));
    csv += row.line();
  }
  return csv;
}

std::string settings_csv(const Results& results) {
  const Design& design = results.design();
  const std::vector<std::string> names = kept_numbers(results);
  std::vector<std::vector<SettingNumber>> numbers;
  for (const std::string& name : names) numbers.push_back(setting_numbers(results, name));
  Row head;
  head.word("setting").words(design.columns());
  head.words({"finished", "met", "failed", "met_share", "met_share_low", "met_share_high"});
  for (const std::string& name : names) {
    for (const char* what : {"count", "mean", "deviation", "median", "mean_low", "mean_high"}) {
      head.word(fmt::format("{}:{}", name, what));
    }
  }
  std::string csv = head.line();
  for (std::size_t setting = 0; setting < design.settings(); ++setting) {
    const SettingCount count = count_setting(results, setting);
    Row row;
    row.count(setting).words(design.texts(setting));
    row.count(count.finished).count(count.met).count(count.failed);
    if (count.finished > 0) {
      const Interval share = count.met_interval();
      row.number(count.met_share());
      row.number(share.low).number(share.high);
    } else {
      row.words({"", "", ""});
    }
    for (const std::vector<SettingNumber>& number : numbers) {
      std::vector<double> values = number[setting].values;
      std::sort(values.begin(), values.end());
      const Interval mean = number[setting].interval;
      row.count(values.size()).number(number[setting].mean).number(summarise(values).deviation);
      row.number(values.empty() ? kNoNumber : quantile(values, 0.5));
      row.number(std::isfinite(mean.low) ? mean.low : kNoNumber);
      row.number(std::isfinite(mean.high) ? mean.high : kNoNumber);
    }
    csv += row.line();
  }
  return csv;
}

std::string costs_csv(const Results& results) {
  std::string csv = "cell,wall_s,cpu_s,peak_MB,host\n";
  for (std::size_t cell = 0; cell < results.design().cells(); ++cell) {
    if (!is_finished(results.state(cell))) continue;
    const CellCost& cost = results.cost(cell);
    csv += Row()
               .count(cell)
               .number(cost.wall_s)
               .number(cost.cpu_s)
               .number(cost.peak_MB)
               .word(cost.host)
               .line();
  }
  return csv;
}

}  // namespace vinerow::study
