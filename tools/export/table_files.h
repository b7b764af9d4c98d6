#pragma once
/// Tables as files that pandas, numpy and spreadsheets open.

#include <filesystem>
#include <string>

#include "engine/core/error.h"
#include "tools/export/message_table.h"

namespace vinerow::tools {

/// A table has more columns or bytes than a file can take.
class TableTooLarge : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

/// Columns of one file at most: beyond that no reader is of use, and zip files need other records.
constexpr std::size_t kMostColumns = 65'534;

/// Comma-separated (RFC 4180), a heading first. A column of several values becomes name[0],
/// name[1], ...; what a row does not have is empty. Numbers are the shortest that read back to the
/// same bits; "nan", "inf", "-inf".
/// @param what  stands first in messages: "/rover/scan"
/// @throws TableTooLarge "/run/map: has 562430 columns, must be at most 65534; ..."
std::string csv_of(const MessageTable& table, const std::string& what);

/// A zip file of .npy arrays, not compressed, for numpy.load(). A column of several values is
/// two-dimensional. What a row does not have is NaN, so that whole numbers become float64 there; of
/// text it is "".
/// @throws TableTooLarge also "/rover/scan: its arrays take more than 4 GiB, ..."
std::string npz_of(const MessageTable& table, const std::string& what);

}  // namespace vinerow::tools
