// SHA-256 of a stream of bytes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace tessemu {

class Sha256 {
public:
    Sha256();
    ~Sha256();
    void add(void const* bytes, std::size_t count);
    /// Lower-case hex of everything added; call once.
    std::string hex();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Of a text.
std::string sha256_of(std::string const& text);

} // namespace tessemu
