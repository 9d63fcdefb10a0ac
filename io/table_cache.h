// Basis-function tables on disk, shared by runs and processes.
//
// A file holds the tables of one patch type. Its name is the SHA-256 of the type's bytes and the
// format's version, so whatever a name promises is in the file or nothing is: a file appears whole,
// under its name, when its temporary is renamed (output_file.h), and carries the checksum of all
// that follows. One that is cut short, changed, of another type or version is made again and
// replaced.
//
//     "tessemu basis tables 1\n"   then the SHA-256 of the rest in hex, "\n"
//     type's bytes and points beyond, each with its count; points; position, du, dv
//
// Numbers are little-endian, weights doubles.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/table_store.h"
#include "pipeline/mesh/warnings.h"

#include <filesystem>

namespace tessemu {

class BasisTableCache : public BasisTableStore {
public:
    /// \param folder  made when the first tables are kept
    /// \param warn    hears once that the folder takes no file; empty: nobody need know
    explicit BasisTableCache(std::filesystem::path folder, WarningSink warn = {});

    /// From memory, or from the folder.
    std::optional<BasisTables> find(PatchType const& type) override;
    void keep(PatchType const& type, BasisTables const& tables) override;

    std::filesystem::path const& folder() const { return folder_; }
    std::filesystem::path file_of(PatchType const& type) const;
    std::uint64_t bytes_written() const { return bytes_written_; }

private:
    std::filesystem::path folder_;
    WarningSink warn_;
    BasisTableMemory memory_;
    bool takes_files_ = true;
    std::uint64_t bytes_written_ = 0;
};

/// $XDG_CACHE_HOME/tessemu, or ~/.cache/tessemu; empty: the environment names neither.
std::filesystem::path default_table_cache();

/// The content of a type's file.
std::string table_file(PatchType const& type, BasisTables const& tables);
/// None: not such a file, or not of this type.
std::optional<BasisTables> read_table_file(std::string_view bytes, PatchType const& type);

} // namespace tessemu
