/* Why a file in Lua is refused, as one text. What the compiler of steve says of a class in Lua stands at a line of a
   text that only breve knows; here it gets the place of breve.class in the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "binding.h"

void bl_tell(breve_write_fn reason, void* sink, const char* text) {
  if (reason) reason(sink, text, strlen(text));
}

void bl_tell_last(const breve_runtime* runtime, breve_status status, breve_write_fn reason, void* sink) {
  const breve_error* error = breve_runtime_last_error(runtime);
  bl_tell(reason, sink, error && error->status == (uint32_t)status ? error->message : breve_status_name(status));
}

/* ---- a text that grows ------------------------------------------------------------------------------------------------- */

typedef struct report {
  char* bytes; /* NULL: there is no memory */
  size_t size;
} report;

static void add(report* r, const char* text) {
  const size_t length = strlen(text);
  char* larger = r->bytes ? (char*)realloc(r->bytes, r->size + length + 1) : NULL;
  if (!larger) {
    free(r->bytes);
    r->bytes = NULL;
    return;
  }
  memcpy(larger + r->size, text, length + 1);
  r->bytes = larger;
  r->size += length;
}

/* ---- errors of a compilation ------------------------------------------------------------------------------------------- */

static const bl_class* class_of(const bl_program* program, const breve_diagnostic* d) {
  return strncmp(d->file, "host:", 5) == 0 ? bl_program_class(program, d->file + 5) : NULL;
}

static void add_error(report* r, const bl_program* program, const breve_diagnostic* d) {
  const bl_class* owner = class_of(program, d);
  const char* name = program->texts ? program->texts[0].name : "lua";
  char line[24] = "";
  if (!owner && strcmp(d->file, name) != 0) { /* in a module in steve */
    add(r, d->text);
    if (r->bytes && r->size > 0 && r->bytes[r->size - 1] == '\n') r->bytes[--r->size] = 0;
    return;
  }
  if (owner && owner->file[0]) {
    snprintf(line, sizeof line, ":%u", (unsigned)owner->line);
    name = owner->file;
  }
  add(r, name);
  add(r, line);
  add(r, ": error: ");
  add(r, d->message);
  if (d->help[0] == 0) return;
  add(r, "\nhelp: ");
  const bool of_class = owner && strstr(d->help, "breve_class.modules") != NULL;
  add(r, of_class ? "name the file that defines it in breve.use, or define it by breve.class" : d->help);
}

void bl_tell_errors(const breve_runtime* runtime, const bl_program* program, breve_write_fn reason, void* sink) {
  static const char* const title = "the program does not compile";
  report r = {(char*)calloc(1, 1), 0};
  breve_diagnostic d;
  add(&r, title);
  /* Classes in Lua come first: their errors make others, in modules. */
  for (int of_class = 1; of_class >= 0; --of_class)
    for (size_t i = 0; i < breve_runtime_diagnostic_count(runtime); ++i) {
      if (breve_runtime_diagnostic(runtime, i, &d) != BREVE_OK || d.severity != BREVE_SEVERITY_ERROR) continue;
      if ((class_of(program, &d) != NULL) != (of_class == 1)) continue;
      add(&r, "\n");
      add_error(&r, program, &d);
    }
  bl_tell(reason, sink, r.bytes ? r.bytes : title);
  free(r.bytes);
}
