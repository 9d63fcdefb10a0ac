// Whether the build has a sanitizer, under which tests that go over many cases take fewer.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tessemu::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSlow = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSlow = true;
#else
inline constexpr bool kSlow = false;
#endif
#else
inline constexpr bool kSlow = false;
#endif

} // namespace tessemu::test
