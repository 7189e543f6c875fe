// Nacre: which names a shared library shows.
#pragma once

#if defined(__GNUC__)
#define NACRE_API __attribute__((visibility("default")))
#else
#define NACRE_API
#endif
