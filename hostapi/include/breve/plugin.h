/* plugin.h: functions and classes in shared libraries that programs name with `@plugin "file"(entry).` A part of
 * breve.h, whose rules hold here.
 *
 *     BREVE_PLUGIN(start, runtime) {
 *       breve_function f = breve_function_default();
 *       ...
 *       return breve_runtime_add_function(runtime, &f);
 *     }
 *
 * A plugin belongs to the programs that name it. Two programs of one runtime share it, with the same functions and
 * classes; a program that does not name it does not see them. A function or class of a plugin never
 * replaces another one: a name that the program already has is an error. Plugins run with all rights of the process. See
 * docs/plugins.md.
 */
#ifndef BREVE_PLUGIN_H
#define BREVE_PLUGIN_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- plugins ----------------------------------------------------------------------------------------------------- */

#if defined(_WIN32)
#define BREVE_PLUGIN_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define BREVE_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define BREVE_PLUGIN_EXPORT
#endif

#ifdef __cplusplus
#define BREVE_PLUGIN_LINKAGE extern "C"
#else
#define BREVE_PLUGIN_LINKAGE
#endif

/* Begins the definition of a plugin's entry, in C or C++: BREVE_PLUGIN(start, runtime) { return ...; }. A library with
   another BREVE_ABI than the header that the plugin was compiled with refuses it. */
#define BREVE_PLUGIN(entry, runtime)                                                                  \
  static breve_status entry##_body(breve_runtime* runtime);                                           \
  BREVE_PLUGIN_LINKAGE BREVE_PLUGIN_EXPORT breve_status entry(breve_runtime* runtime, uint32_t abi);  \
  BREVE_PLUGIN_LINKAGE BREVE_PLUGIN_EXPORT breve_status entry(breve_runtime* runtime, uint32_t abi) { \
    return abi == BREVE_ABI ? entry##_body(runtime) : BREVE_ERROR_UNSUPPORTED;                        \
  }                                                                                                   \
  static breve_status entry##_body(breve_runtime* runtime)

/* Opens a shared library and finds its entry, for a breve_open_plugin_fn. The path is used as it is: the caller decides
   which libraries a program may load.
   @param path    of the library; one without '/' is searched by the rules of the system's loader
   @param entry   name of a function that BREVE_PLUGIN defines
   @param plugin  filled in; its `close` unloads the library
   @param reason  called with `sink` and the reason if the library is not opened; may be NULL
   BREVE_OK; BREVE_ERROR_FILE: the system cannot load the library; BREVE_ERROR_NOT_FOUND: it has no such entry;
   BREVE_ERROR_UNSUPPORTED: this build cannot load libraries. */
BREVE_API breve_status breve_plugin_open(const char* path, const char* entry, breve_plugin* plugin,
                                         breve_write_fn reason, void* sink);

#ifdef __cplusplus
}
#endif

#endif
