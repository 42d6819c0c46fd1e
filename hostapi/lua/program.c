/* What a Lua file defines, kept apart from any state of Lua: texts, classes, methods. Its memory is C's own, as it
   belongs to a runtime and not to a world. */
#include <stdlib.h>
#include <string.h>

#include "binding.h"

char* bl_copy(const char* text, char from, char to) {
  const size_t size = strlen(text) + 1;
  char* copy = (char*)malloc(size);
  for (size_t i = 0; copy && i < size; ++i) copy[i] = text[i] == from ? to : text[i];
  return copy;
}

/* Room for one more element in an array of `count`; its size doubles. False: there is no memory. */
static bool grow(void** array, size_t count, size_t element) {
  if ((count & (count - 1)) != 0) return true; /* it is full only at a power of two */
  const size_t room = count == 0 ? 1 : 2 * count;
  void* larger = realloc(*array, room * element);
  if (larger) *array = larger;
  return larger != NULL;
}

bl_program* bl_program_new(const breve_lua_config* config, const char* name, const char* text, size_t size) {
  bl_program* program = (bl_program*)calloc(1, sizeof *program);
  if (!program) return NULL;
  program->holders = 1;
  program->config = *config;
  if (name && !bl_program_add_text(program, name, text, size)) {
    bl_program_drop(program);
    return NULL;
  }
  return program;
}

void bl_program_hold(bl_program* program) { __atomic_add_fetch(&program->holders, 1, __ATOMIC_RELAXED); }

static void drop_class(bl_class* owner) {
  for (size_t i = 0; i < owner->method_count; ++i) {
    bl_method* m = owner->methods[i];
    for (size_t k = 0; k < m->count; ++k) free(m->keywords[k]), free(m->parameters[k]);
    free(m->name), free(m->selector), free(m->file), free(m);
  }
  free(owner->methods), free(owner->name), free(owner->parent), free(owner->file), free(owner);
}

/* Worlds of several threads may hold one program. */
void bl_program_drop(void* user) {
  bl_program* program = (bl_program*)user;
  if (!program || __atomic_sub_fetch(&program->holders, 1, __ATOMIC_ACQ_REL) != 0) return;
  for (size_t i = 0; i < program->text_count; ++i) free(program->texts[i].name), free(program->texts[i].bytes);
  for (size_t i = 0; i < program->use_count; ++i) free(program->uses[i]);
  for (size_t i = 0; i < program->class_count; ++i) drop_class(program->classes[i]);
  free(program->texts), free(program->uses), free(program->classes), free(program->controller), free(program);
}

bl_class* bl_program_class(const bl_program* program, const char* name) {
  for (size_t i = 0; program && name && i < program->class_count; ++i)
    if (strcmp(program->classes[i]->name, name) == 0) return program->classes[i];
  return NULL;
}

bl_text* bl_program_text(bl_program* program, const char* name) {
  for (size_t i = 0; i < program->text_count; ++i)
    if (strcmp(program->texts[i].name, name) == 0) return &program->texts[i];
  return NULL;
}

bl_text* bl_program_add_text(bl_program* program, const char* name, const char* bytes, size_t size) {
  if (!grow((void**)&program->texts, program->text_count, sizeof *program->texts)) return NULL;
  bl_text text = {bl_copy(name, 0, 0), (char*)malloc(size + 1), size};
  if (!text.name || !text.bytes) {
    free(text.name), free(text.bytes);
    return NULL;
  }
  if (size != 0) memcpy(text.bytes, bytes, size);
  text.bytes[size] = 0;
  program->texts[program->text_count] = text;
  return &program->texts[program->text_count++];
}

bool bl_program_add_use(bl_program* program, const char* name) {
  if (!grow((void**)&program->uses, program->use_count, sizeof *program->uses)) return false;
  char* copy = bl_copy(name, 0, 0);
  if (copy) program->uses[program->use_count++] = copy;
  return copy != NULL;
}

/* A settled class of a draft takes another parent. */
static bool settle_anew(bl_class* known, const char* parent) {
  char* copy = bl_copy(parent, 0, 0);
  if (!copy) return false;
  free(known->parent);
  known->parent = copy;
  known->settled = false;
  return true;
}

bl_class* bl_program_add_class(bl_program* program, const char* name, const char* parent) {
  bl_class* known = bl_program_class(program, name);
  if (known) return settle_anew(known, parent) ? known : NULL;
  if (!grow((void**)&program->classes, program->class_count, sizeof *program->classes)) return NULL;
  bl_class* made = (bl_class*)calloc(1, sizeof *made);
  if (!made) return NULL;
  made->program = program;
  made->name = bl_copy(name, 0, 0);
  made->parent = bl_copy(parent, 0, 0);
  program->classes[program->class_count++] = made;
  return made->name && made->parent ? made : NULL;
}

bool bl_class_place(bl_class* owner, const char* file, uint32_t line) {
  char* copy = bl_copy(file, 0, 0);
  if (!copy) return false;
  free(owner->file);
  owner->file = copy;
  owner->line = line;
  return true;
}

bl_method* bl_class_add_method(bl_program* program, bl_class* owner, const char* name) {
  if (!grow((void**)&owner->methods, owner->method_count, sizeof *owner->methods)) return NULL;
  bl_method* made = (bl_method*)calloc(1, sizeof *made);
  if (!made) return NULL;
  made->owner = owner;
  made->index = ++program->method_count;
  made->name = bl_copy(name, 0, 0);
  made->selector = bl_copy(name, '_', '-');
  owner->methods[owner->method_count++] = made;
  return made->name && made->selector ? made : NULL;
}

bl_method* bl_class_method(const bl_class* owner, const char* name) {
  for (size_t i = 0; i < owner->method_count; ++i)
    if (strcmp(owner->methods[i]->name, name) == 0) return owner->methods[i];
  return NULL;
}

bl_program* bl_program_of_draft(bl_program* draft) {
  bl_program* made = bl_program_new(&draft->config, NULL, NULL, 0);
  bool good = made != NULL;
  for (size_t i = 0; good && i < draft->use_count; ++i) good = bl_program_add_use(made, draft->uses[i]);
  for (size_t i = 0; good && i < draft->class_count; ++i) {
    const bl_class* drafted = draft->classes[i];
    bl_class* copy = bl_program_add_class(made, drafted->name, drafted->parent);
    good = copy && bl_class_place(copy, drafted->file, drafted->line);
  }
  if (good && draft->controller) good = (made->controller = bl_copy(draft->controller, 0, 0)) != NULL;
  for (size_t i = 0; good && i < draft->class_count; ++i) draft->classes[i]->settled = true;
  if (good) return made;
  bl_program_drop(made);
  return NULL;
}
