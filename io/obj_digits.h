// How many digits a file's numbers have.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace tessemu {

/// How a file writes the coordinates of its vertices: whether in a format of so many significant
/// digits, such as %g, which has lost those behind. Whole numbers and a fixed number of decimals
/// may be all there is to say.
class WrittenDigits {
public:
    /// \param number  a word that is one; the text outlives this
    void see(std::string_view number);
    /// How many there are at most, if that is the format's doing: several numbers have so many at
    /// different powers of ten, or one has none at 1.
    std::optional<int> limit() const;

private:
    static constexpr std::size_t kLeast = 6, kAllOfADouble = 15, kSeveral = 3;
    std::size_t most_ = 0; ///< digits of a number, without leading zeros
    /// By the power of ten of the last digit, some different numbers with so many digits.
    std::map<std::int64_t, std::set<std::string_view>> full_;
};

} // namespace tessemu
