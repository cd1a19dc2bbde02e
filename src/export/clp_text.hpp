// The C99 text of the constraint optimizer (clp/), made part of the program by CMake.
#pragma once

namespace fpc {

extern const char* const kClpQpTypes;  ///< clp/qp.h
extern const char* const kClpTypes;    ///< clp/law.h
extern const char* const kClpQp;       ///< clp/qp.c
extern const char* const kClp;         ///< clp/law.c

}  // namespace fpc
