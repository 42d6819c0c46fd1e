/* breve/analysis.h: the structure of a program, for editors, documentation and interactive use: the names of a program,
   their positions and their meaning. The program is not run, and it may still be incomplete and contain errors.
 * A host that only runs worlds does not need this header.
 *
 *     breve_analysis* analysis;
 *     breve_analysis_create(runtime, "hello.tz", text, size, &analysis);
 *     for (i = 0; i < breve_analysis_symbol_count(analysis); ++i) breve_analysis_symbol(analysis, i, &symbol);
 *
 * The rules of breve.h also apply here.
 */
#ifndef BREVE_ANALYSIS_H
#define BREVE_ANALYSIS_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An analysis describes the text at the time when it was created and never changes. It is used by one thread at a time,
   and does not need its runtime any more once it exists.
   Positions are lines and columns from 1, with columns in bytes; `file` is a name as breve_analysis_file returns it.
   Texts that an analysis returns belong to it and live as long as it does, unless noted otherwise. */
typedef struct breve_analysis breve_analysis;

/* A range of a text. All 0 and "" if there is none, for example for a function of the language itself. */
typedef struct breve_span {
  const char* file; /* never NULL */
  uint32_t line, column;
  uint32_t end_line, end_column; /* directly after its last byte */
  uint32_t offset, length;       /* the same in bytes of the file */
} breve_span;

/* The text of one file of a program. */
typedef struct breve_source {
  const char* name; /* as diagnostics show it; a module of the class library is "library:Real.tz" */
  const char* text; /* `size` bytes, followed by a zero byte */
  size_t size;
  bool library; /* of the class library */
  bool loaded;  /* by the program. False: a module of the class library that the program does not use */
} breve_source;

/* The number of modules of the class library. */
BREVE_API size_t breve_library_module_count(void);

/* The class library's module at `index`, in alphabetical order. Its name is "Real.tz", without the prefix "library:" of
   diagnostics and analyses; its texts live as long as the library; `loaded` is false.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_library_module(size_t index, breve_source* module);

/* Analyses the program whose main module is `name`: reads it like breve_program_compile, with everything that it loads,
   and keeps what it finds even if there are errors. Runs no script, and does not change breve_runtime_diagnostic.
   @param text      `size` bytes, copied; NULL with size 0: the runtime's resolve_module provides the module
   @param analysis  to be released with breve_analysis_destroy
   BREVE_OK, also if the program has errors: see breve_analysis_diagnostic; BREVE_ERROR_FILE: no such module;
   BREVE_ERROR_BUSY from a callback of a compilation. */
BREVE_API breve_status breve_analysis_create(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                             breve_analysis** analysis);

/* Does nothing for NULL. */
BREVE_API void breve_analysis_destroy(breve_analysis* analysis);

/* The errors and warnings of the program, like breve_runtime_diagnostic_count. */
BREVE_API size_t breve_analysis_diagnostic_count(const breve_analysis* analysis);
/* As breve_runtime_diagnostic. */
BREVE_API breve_status breve_analysis_diagnostic(const breve_analysis* analysis, size_t index,
                                                 breve_diagnostic* diagnostic);

/* The files: the main module first, then those that it loads, then the rest of the class library.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API size_t breve_analysis_file_count(const breve_analysis* analysis);
BREVE_API breve_status breve_analysis_file(const breve_analysis* analysis, size_t index, breve_source* file);

/* The kind of thing that a name denotes. */
typedef enum breve_name_kind {
  BREVE_NAME_MODULE = 0, /* a file */
  BREVE_NAME_CLASS = 1,  /* also by its alias (aka) */
  BREVE_NAME_METHOD = 2,
  BREVE_NAME_KEYWORD = 3,    /* `to` in `+ to set-velocity to v (vector):` */
  BREVE_NAME_PARAMETER = 4,  /* `v` there */
  BREVE_NAME_VARIABLE = 5,   /* of an instance */
  BREVE_NAME_LOCAL = 6,      /* a variable of a method */
  BREVE_NAME_FUNCTION = 7,   /* sqrt and other functions of the language */
  BREVE_NAME_CONSTANT = 8,   /* from @define */
  BREVE_NAME_TYPE = 9,       /* int, vector, object ... */
  BREVE_NAME_DIRECTIVE = 10, /* `use` after an @ */
  BREVE_NAME_WORD = 11       /* another reserved word */
} breve_name_kind;

#define BREVE_NO_SYMBOL ((size_t)-1)

/* Something that the program, the class library or the language defines. Texts are never NULL. */
typedef struct breve_symbol {
  uint32_t kind; /* breve_name_kind: from BREVE_NAME_MODULE to BREVE_NAME_CONSTANT */
  const char* name;
  const char* signature;     /* for people to read: "set-velocity to v (vector)", "Mobile : Bird (aka Birds)" */
  const char* type;          /* of a variable, parameter, keyword: "float", "Bird object", "5 ints"; of a method or
                                function: the type of its result, "" if it has none or it is not declared */
  const char* value;         /* of a constant, and the default of a keyword, as written; "" if there is none */
  const char* documentation; /* its % lines without the %; for a variable or constant the # comment after it; for a
                                function one line; "" if there is none */
  const char* owner;         /* the class that contains it; "" outside of classes */
  const char* parent_class;  /* of a class, "" for a root class; otherwise "" */
  const char* alias;         /* of a class, its alias or ""; otherwise "" */
  size_t parent;             /* the symbol that it is part of: for a method or instance variable the class, for a
                                keyword, parameter or local the method, for a class the module; or BREVE_NO_SYMBOL */
  breve_span name_span;      /* of the name in the declaration */
  breve_span span;           /* of the whole declaration */
  bool library;              /* of the class library, or a function of the language */
  bool loaded;               /* part of the program. False: in a module of the class library that the program does not
                                use */
  bool hidden;               /* a method declared with '-' or '=': not meant for other classes */
} breve_symbol;

/* The number of symbols: modules, each followed by its declarations in the order of the text, starting with the modules
   of the program in order of loading; functions come last. A name that is declared several times has several
   symbols. */
BREVE_API size_t breve_analysis_symbol_count(const breve_analysis* analysis);

/* BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_analysis_symbol(const breve_analysis* analysis, size_t index, breve_symbol* symbol);

/* A name at a position. */
typedef struct breve_reference {
  uint32_t kind; /* breve_name_kind: the meaning of the name there */
  const char* name;
  const char* type;      /* static type of the variable, or class of the receiver of the method or keyword, if known:
                            "Bird object"; otherwise "" */
  const char* signature; /* of the symbol; for a reserved word its usage: "foreach item in list: statement" */
  const char* documentation; /* of the symbol or reserved word; or "" */
  breve_span span;
  size_t symbol;    /* the most likely one, see breve_analysis_definitions; or BREVE_NO_SYMBOL */
  bool declaration; /* the name is declared here */
} breve_reference;

/* The name at a position: the position is inside the name or directly after it.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such file, no such position, or no name there. */
BREVE_API breve_status breve_analysis_name_at(const breve_analysis* analysis, const char* file, uint32_t line,
                                              uint32_t column, breve_reference* reference);

/* The symbols that the name at a position may refer to, the most likely first. For a method call on a receiver of a
   known class this is the method found there or in its ancestors; for other receivers, every method of that name that
   takes the keywords.
   @param symbols  room for `capacity` numbers; NULL only if capacity is 0
   @param count    the total number, even if it exceeds capacity; at most capacity are written
   BREVE_OK, with count 0 if the name is unknown; BREVE_ERROR_NOT_FOUND as for breve_analysis_name_at. */
BREVE_API breve_status breve_analysis_definitions(const breve_analysis* analysis, const char* file, uint32_t line,
                                                  uint32_t column, size_t* symbols, size_t capacity, size_t* count);

/* The positions in the program's files (not the class library's) that refer to a symbol, including its declaration, in
   order of files and positions. Calls of a method are included even if the receiver's class is not known.
   @param spans  room for `capacity`; NULL only if capacity is 0
   @param count  the total number, even if it exceeds capacity; at most capacity are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND if there is no such symbol. */
BREVE_API breve_status breve_analysis_references(const breve_analysis* analysis, size_t symbol, breve_span* spans,
                                                 size_t capacity, size_t* count);

/* The methods that the call around a position may refer to, the most likely first, and the keyword whose value is
   there. The text may be incomplete.
   @param symbols, capacity, count  as for breve_analysis_definitions
   @param keyword  may be NULL; "" before the first one; owned by the analysis until the next call of this function
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the position is not after the selector of a call, or there is no such file or
   position. */
BREVE_API breve_status breve_analysis_callees(const breve_analysis* analysis, const char* file, uint32_t line,
                                              uint32_t column, size_t* symbols, size_t capacity, size_t* count,
                                              const char** keyword);

/* A name that is possible at a position. Texts live until the next call of a completion function on the analysis. */
typedef struct breve_completion {
  uint32_t kind;             /* breve_name_kind */
  const char* name;          /* replaces the part that has been typed */
  const char* detail;        /* the signature of its symbol; for a reserved word its usage; or "" */
  const char* owner;         /* the class that declares it, or "" */
  const char* documentation; /* or "" */
  size_t symbol;             /* or BREVE_NO_SYMBOL */
} breve_completion;

/* The names that are possible at a position and begin with the part of a name that is typed before it, ignoring case:
   selectors after a receiver, keywords in a call, classes after `new`, `all` and in types, variables, constants,
   functions and reserved words where an expression or statement may begin, types after the '(' of a declaration,
   directives after an '@', variables after a `$` in a string. None inside comments. The most likely come first.
   @param typed  may be NULL: the number of bytes before the position that the name replaces
   @param items  room for `capacity`; NULL only if capacity is 0
   @param count  the total number, even if it exceeds capacity; at most capacity are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such file or position. */
BREVE_API breve_status breve_analysis_completions(const breve_analysis* analysis, const char* file, uint32_t line,
                                                  uint32_t column, uint32_t* typed, breve_completion* items,
                                                  size_t capacity, size_t* count);

/* The same for a statement that is being typed and is not part of any file, as if it were in a method of a class.
   @param class_name  a class of the program or the class library, name or alias; NULL: none, so that `self` is unknown
   @param text        the statement, `size` bytes; NULL only if size is 0
   @param offset      the position, in bytes; at most size
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such class; BREVE_ERROR_ARGUMENT: offset beyond size. */
BREVE_API breve_status breve_analysis_statement_completions(const breve_analysis* analysis, const char* class_name,
                                                            const char* text, size_t size, size_t offset,
                                                            uint32_t* typed, breve_completion* items, size_t capacity,
                                                            size_t* count);

#ifdef __cplusplus
}
#endif

#endif
