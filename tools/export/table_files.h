#pragma once
/// Table files for pandas, NumPy and spreadsheets.

#include <filesystem>
#include <string>

#include "engine/core/error.h"
#include "tools/export/message_table.h"

namespace vinerow::tools {

/// Thrown if a table has more columns or bytes than a file can take.
class TableTooLarge : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

/// Maximum number of columns of a file: zip files with more members need other records, and readers
/// cannot handle them.
constexpr std::size_t kMaxColumns = 65'534;

/// Comma-separated values (RFC 4180) with a heading. A column with several values becomes name[0],
/// name[1], ...; missing values are empty. Numbers are written in the shortest form that reads back
/// to the same bits; "nan", "inf", "-inf".
/// @param what  first word of messages: "/rover/scan"
/// @throws TableTooLarge "/run/map: has 562430 columns, must be at most 65534; ..."
std::string csv_of(const MessageTable& table, const std::string& what);

/// Uncompressed zip file of .npy arrays, for numpy.load(). A column with several values is
/// two-dimensional. Missing numbers are NaN, which turns integer columns into float64; missing
/// texts are "".
/// @param are_pictures  messages are CompressedImage: PNG files of one size in 8-bit RGB, or 8-bit
/// or
///   16-bit grey become the array `pixels`, (rows, height, width, 3) or (rows, height, width), in
///   place of `data`
/// @throws TableTooLarge also "/rover/scan: its arrays take more than 4 GiB, ..."
std::string npz_of(const MessageTable& table, const std::string& what, bool are_pictures = false);

}  // namespace vinerow::tools
