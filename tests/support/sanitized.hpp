// SPDX-License-Identifier: GPL-3.0-or-later
// Whether this is built with the address sanitizer. Its shadow memory reserves terabytes of addresses and uses
// megabytes, and it makes code several times as slow.
#pragma once

namespace eomgen::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace eomgen::test
