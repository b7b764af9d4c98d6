#pragma once
/// Flag of dlopen() with which a library takes symbols from its own libraries before those that the
/// program has loaded. The address sanitizer refuses it: its functions must come first.

#include <dlfcn.h>

namespace vinerow {

#ifdef __SANITIZE_ADDRESS__
inline constexpr int kOwnLibrariesFirst = 0;
#else
inline constexpr int kOwnLibrariesFirst = RTLD_DEEPBIND;
#endif

}  // namespace vinerow
