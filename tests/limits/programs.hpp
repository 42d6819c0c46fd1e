// The programs whose allocations are failed, as modules of a runtime.
//
// - everything.tz: what a world can do. Its loops are short: more iterations allocate at the same places again.
// - grammar.tz: what the compiler can meet, with little of the class library.
// - little.tz: the least that shows that a runtime still works.
#pragma once

#include "breve/breve.h"

namespace limits {

/// A breve_resolve_module_fn for them.
bool resolve_program(void*, const char* name, const char* from, breve_module* module);

}  // namespace limits
