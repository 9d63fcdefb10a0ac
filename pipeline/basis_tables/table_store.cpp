// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/table_store.h"

namespace tessemu {

std::optional<BasisTables> BasisTableMemory::find(PatchType const& type)
{
    auto const found = by_type_.find(type);
    if (found == by_type_.end()) return {};
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->tables;
}

void BasisTableMemory::keep(PatchType const& type, BasisTables const& tables)
{
    if (auto const found = by_type_.find(type); found != by_type_.end()) {
        bytes_ -= found->second->tables.bytes();
        entries_.erase(found->second);
        by_type_.erase(found);
    }
    if (tables.bytes() > most_bytes_) return;
    while (bytes_ + tables.bytes() > most_bytes_) {
        bytes_ -= entries_.back().tables.bytes();
        by_type_.erase(entries_.back().type);
        entries_.pop_back();
    }
    entries_.push_front({type, tables});
    by_type_[type] = entries_.begin();
    bytes_ += tables.bytes();
}

} // namespace tessemu
