// Where basis-function tables are kept from mesh to mesh, and from run to run.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/generator.h"

#include <list>
#include <map>
#include <optional>

namespace tessemu {

/// Used by one thread at a time.
class BasisTableStore {
public:
    virtual ~BasisTableStore() = default;
    /// None: they have to be made.
    virtual std::optional<BasisTables> find(PatchType const& type) = 0;
    /// May be lost: a store that is full, or cannot be written, does no harm.
    virtual void keep(PatchType const& type, BasisTables const& tables) = 0;
};

/// In memory, up to a number of bytes: those that were not asked for longest go first.
class BasisTableMemory : public BasisTableStore {
public:
    explicit BasisTableMemory(std::size_t most_bytes = std::size_t(256) << 20)
        : most_bytes_(most_bytes)
    {
    }
    std::optional<BasisTables> find(PatchType const& type) override;
    void keep(PatchType const& type, BasisTables const& tables) override;
    std::size_t bytes() const { return bytes_; }
    std::size_t size() const { return entries_.size(); }

private:
    struct Entry {
        PatchType type;
        BasisTables tables;
    };
    std::size_t most_bytes_, bytes_ = 0;
    std::list<Entry> entries_; // last asked for first
    std::map<PatchType, std::list<Entry>::iterator> by_type_;
};

} // namespace tessemu
