// SPDX-License-Identifier: Apache-2.0
#include "io/table_cache.h"

#include "io/input_file.h"
#include "io/output_file.h"
#include "io/sha256.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace tessemu {

namespace fs = std::filesystem;

namespace {

// The number grows with any change of the format, of PatchType::bytes(), or of the weights.
constexpr std::string_view kMagic = "tessemu basis tables 1\n";
constexpr std::size_t kChecksum = 64;

void add_number(std::string& out, std::uint64_t x, int bytes)
{
    for (int i = 0; i < bytes; ++i) out += char(x >> (8 * i));
}

std::optional<std::uint64_t> take_number(std::string_view& rest, int bytes)
{
    if (rest.size() < std::size_t(bytes)) return {};
    std::uint64_t out = 0;
    for (int i = 0; i < bytes; ++i)
        out |= std::uint64_t(static_cast<unsigned char>(rest[std::size_t(i)])) << (8 * i);
    rest.remove_prefix(std::size_t(bytes));
    return out;
}

std::string sha256_of_bytes(std::string_view bytes)
{
    Sha256 hash;
    hash.add(bytes.data(), bytes.size());
    return hash.hex();
}

} // namespace

std::string table_file(PatchType const& type, BasisTables const& tables)
{
    std::string const key = type.bytes();
    std::string content;
    content.reserve(tables.bytes() + key.size() + 64);
    add_number(content, key.size(), 4);
    content += key;
    add_number(content, tables.beyond.size(), 4);
    for (std::uint16_t i : tables.beyond) add_number(content, i, 2);
    add_number(content, std::uint64_t(tables.points), 4);
    for (auto const* table : {&tables.position, &tables.du, &tables.dv})
        for (double w : *table) add_number(content, std::bit_cast<std::uint64_t>(w), 8);
    return std::string(kMagic) + sha256_of_bytes(content) + "\n" + content;
}

std::optional<BasisTables> read_table_file(std::string_view bytes, PatchType const& type)
{
    std::size_t const head = kMagic.size() + kChecksum + 1;
    if (bytes.size() < head || !bytes.starts_with(kMagic) || bytes[head - 1] != '\n') return {};
    std::string_view rest = bytes.substr(head);
    if (bytes.substr(kMagic.size(), kChecksum) != sha256_of_bytes(rest)) return {};
    std::string const key = type.bytes();
    auto const key_size = take_number(rest, 4);
    if (!key_size || *key_size != key.size() || !rest.starts_with(key)) return {};
    rest.remove_prefix(key.size());
    BasisTables out;
    auto const beyond = take_number(rest, 4);
    if (!beyond || *beyond > type.beyond_points().size()) return {};
    for (std::uint64_t i = 0; i < *beyond; ++i) {
        auto const number = take_number(rest, 2);
        if (!number || *number >= type.beyond_points().size()) return {};
        out.beyond.push_back(std::uint16_t(*number));
    }
    auto const points = take_number(rest, 4);
    if (!points || *points != std::uint64_t(type.points()) + *beyond) return {};
    out.points = int(*points);
    std::size_t const weights = std::size_t(*points) * kTableSamples;
    if (rest.size() != 3 * 8 * weights) return {};
    for (auto* table : {&out.position, &out.du, &out.dv}) {
        table->reserve(weights);
        for (std::size_t i = 0; i < weights; ++i) {
            double const w = std::bit_cast<double>(*take_number(rest, 8));
            if (!std::isfinite(w)) return {};
            table->push_back(w);
        }
    }
    return out;
}

BasisTableCache::BasisTableCache(fs::path folder, WarningSink warn)
    : folder_(std::move(folder)),
      warn_(std::move(warn))
{
}

fs::path BasisTableCache::file_of(PatchType const& type) const
{
    return folder_ / (sha256_of(std::string(kMagic) + type.bytes()) + ".tables");
}

std::optional<BasisTables> BasisTableCache::find(PatchType const& type)
{
    if (auto tables = memory_.find(type)) return tables;
    fs::path const file = file_of(type);
    std::error_code ec;
    if (!fs::is_regular_file(file, ec)) return {};
    std::optional<BasisTables> out;
    try {
        // A file of another size is none of ours; none is read that is much larger.
        std::size_t const most = 24 * std::size_t(kTableSamples) *
                                     (std::size_t(type.points()) + type.beyond_points().size()) +
                                 (std::size_t(1) << 20);
        out = read_table_file(read_file(file, most), type);
    } catch (Error const&) { // gone, not readable, too large
        return {};
    }
    if (out) memory_.keep(type, *out);
    return out;
}

void BasisTableCache::keep(PatchType const& type, BasisTables const& tables)
{
    memory_.keep(type, tables);
    if (!takes_files_) return;
    try {
        std::error_code ec;
        fs::create_directories(folder_, ec);
        if (!fs::is_directory(folder_))
            throw WriteError(folder_.string() + ": cannot be made" +
                             (ec ? ": " + ec.message() : std::string()));
        fs::path const file = file_of(type);
        if (!fs::is_regular_file(file, ec) && fs::exists(file, ec)) return; // not ours to replace
        std::string const content = table_file(type, tables);
        write_file(file, content);
        bytes_written_ += content.size();
    } catch (std::exception const& e) {
        takes_files_ = false;
        if (warn_) warn_(std::string("tables are not kept for the next run: ") + e.what());
    }
}

fs::path default_table_cache()
{
    auto const from = [](char const* name) {
        char const* const value = std::getenv(name);
        fs::path const path = value ? value : "";
        return path.is_absolute() ? path : fs::path();
    };
    if (fs::path const cache = from("XDG_CACHE_HOME"); !cache.empty()) return cache / "tessemu";
    if (fs::path const home = from("HOME"); !home.empty()) return home / ".cache" / "tessemu";
    return {};
}

} // namespace tessemu
