#pragma once
/// Checks of the program's own logic. A bad file or parameter is not a bug: throw ConfigError
/// (error.h) for those.
///
/// VINEROW_DEMAND is always on. VINEROW_ASSERT is for hot code: on in this project's presets, off
/// if NDEBUG is defined.

namespace vinerow::internal {
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
}

#define VINEROW_DEMAND(condition)                                        \
  do {                                                                   \
    if (!(condition)) [[unlikely]]                                       \
      ::vinerow::internal::check_failed(#condition, __FILE__, __LINE__); \
  } while (false)

#if defined(NDEBUG)
#define VINEROW_ASSERT(condition) static_cast<void>(0)
#else
#define VINEROW_ASSERT(condition) VINEROW_DEMAND(condition)
#endif
