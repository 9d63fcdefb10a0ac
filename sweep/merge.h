// A sweep's results as one table: a row for each case in the manifest's order, a column for each
// option and each figure of a result. The same table whoever computed which case, and when.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/output_file.h"
#include "sweep/manifest.h"

#include <cstdint>
#include <variant>

namespace tessemu {

struct SweepTable {
    using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
    struct Column {
        std::string name; ///< ends in its unit: "domain_shader_fetched_bytes"
        std::string unit; ///< "count", "bytes", "seconds", "diagonals", "radians", ...; or "text"
        std::string meaning; ///< a sentence
    };
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows; ///< cells by column; monostate: the case has none
};

struct SweepMerge {
    SweepTable table; ///< with a row for each case, those without a result too
    std::size_t done = 0, failed = 0, missing = 0;
    std::string first_failure; ///< "case 12: message"; empty: none
};
/// Throws FormatError for results that are damaged.
SweepMerge merge_sweep(SweepManifest const& manifest, std::filesystem::path const& folder);

enum class TableFormat { Csv, Json, Sqlite };
/// By the extension: .csv, .json, .sqlite. Throws Error that names them and the option.
TableFormat table_format(std::filesystem::path const& path, std::string const& option = "-o");

/// RFC 4180, with a head line; numbers in their shortest form that reads back the same.
std::string csv_of(SweepTable const& table);
/// {"schema": "tessemu.sweep_table/1", "columns": [...], "rows": [[...], ...]}
std::string json_of(SweepTable const& table);
/// Tables "cases" and "columns". \returns  the database file's bytes
std::string sqlite_of(SweepTable const& table);
/// The data dictionary: name, unit, meaning.
std::string dictionary_csv_of(SweepTable const& table);

} // namespace tessemu
