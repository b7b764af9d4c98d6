#include "tools/export/listed_files.h"

#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/csv.h"
#include "engine/io/files/output_folder.h"

namespace vinerow::tools {

ListedFiles::ListedFiles(std::filesystem::path folder, const std::string& columns)
    : folder_(std::move(folder)), list_("time_s,logged_s," + columns + ",file\n") {}

void ListedFiles::add(std::int64_t stamp_ns, std::int64_t logged_ns,
                      const std::vector<std::string>& cells, std::string_view bytes,
                      std::string_view ending) {
  const std::string name = fmt::format("{:015d}{}", stamp_ns, ending);
  const std::filesystem::path file = folder_ / name;
  if (count_ == 0) io::make_folder_of(file);
  write_whole_file(file, bytes);
  list_ += fmt::format("{},{},", static_cast<double>(stamp_ns) / 1e9,
                       static_cast<double>(logged_ns) / 1e9);
  for (const std::string& cell : cells) list_ += io::csv_text(cell) + ",";
  list_ += io::csv_text((folder_.filename() / name).string()) + "\n";
  ++count_;
}

int ListedFiles::finish() {
  const std::filesystem::path file = folder_.string() + ".csv";
  io::make_folder_of(file);
  write_whole_file(file, list_);
  return count_;
}

}  // namespace vinerow::tools
