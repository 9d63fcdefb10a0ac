// SPDX-License-Identifier: Apache-2.0
#include "io/obj_digits.h"

#include "io/obj_statements.h"

#include <algorithm>

namespace tessemu {

void WrittenDigits::see(std::string_view number)
{
    std::size_t const e = exponent_in(number);
    std::size_t digits = 0, last = 0;
    for (std::size_t i = 0; i < e; ++i)
        if (number[i] >= '0' && number[i] <= '9' && (digits || number[i] != '0'))
            ++digits, last = i;
    if (digits < std::max(most_, kLeast)) return;
    if (digits > most_) full_.clear();
    most_ = digits;
    std::size_t const point = number.find('.');
    auto const place = point_of(number, e) - std::int64_t(last) - (last < point);
    std::set<std::string_view>& some = full_[place];
    if (some.size() < kSeveral) some.insert(number);
}

std::optional<int> WrittenDigits::limit() const
{
    if (full_.empty() || most_ >= kAllOfADouble) return {};
    auto const several = [](auto const& place) { return place.second.size() == kSeveral; };
    auto const fine = std::find_if(full_.begin(), full_.end(), several);
    auto const coarse = std::find_if(full_.rbegin(), full_.rend(), several);
    bool const differ = fine != full_.end() && coarse->first - fine->first >= 2;
    if (!differ && full_.rbegin()->first <= 0) return {};
    return int(most_);
}

} // namespace tessemu
