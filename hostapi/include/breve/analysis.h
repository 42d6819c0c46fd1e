/* breve/analysis.h: what a program is made of, for editors, documentation and interactive use: the names of a program,
 * where they stand and what they mean, without running it, and also while its text is being written and does not compile
 * yet. A host that runs worlds needs none of it.
 *
 *     breve_analysis* analysis;
 *     breve_analysis_create(runtime, "hello.tz", text, size, &analysis);
 *     for (i = 0; i < breve_analysis_symbol_count(analysis); ++i) breve_analysis_symbol(analysis, i, &symbol);
 *
 * The rules of breve.h hold here as well.
 */
#ifndef BREVE_ANALYSIS_H
#define BREVE_ANALYSIS_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An analysis is made of one moment's text and never changes; it is used by one thread at a time, and does not
   need its runtime any more once it is made.
   Places are lines and columns from 1, columns in bytes; `file` is a name as breve_analysis_file gives it. Texts that
   an analysis gives are its own and live as long as it does, where nothing else is said. */
typedef struct breve_analysis breve_analysis;

/* A piece of a text. All 0 and "": it has no place, as a function of the language itself. */
typedef struct breve_span {
  const char* file; /* never NULL */
  uint32_t line, column;
  uint32_t end_line, end_column; /* just behind its last byte */
  uint32_t offset, length;       /* the same in bytes of the file */
} breve_span;

/* A text that a program is made of. */
typedef struct breve_source {
  const char* name; /* as diagnostics show it; a module of the class library is "library:Real.tz" */
  const char* text; /* `size` bytes, ended by a zero byte behind them */
  size_t size;
  bool library; /* of the class library */
  bool loaded;  /* by the program. False: a module of the class library that it does not use */
} breve_source;

/* How many modules the class library has. */
BREVE_API size_t breve_library_module_count(void);

/* The class library's module at `index`, in order of the alphabet. Its name is "Real.tz", without the "library:" that
   diagnostics and analyses put before it; its texts live as long as the library; `loaded` is false.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_library_module(size_t index, breve_source* module);

/* Look at the program whose main module is `name`: read it as breve_program_compile does, with all that it loads, and
   keep all that is known in spite of errors. Runs no script, and leaves breve_runtime_diagnostic as it is.
   @param text      `size` bytes, copied; NULL with size 0: the module is asked of the runtime's resolve_module
   @param analysis  to be given back to breve_analysis_destroy
   BREVE_OK, also if the program has errors: see breve_analysis_diagnostic; BREVE_ERROR_FILE: no such module;
   BREVE_ERROR_BUSY from a callback of a compilation. */
BREVE_API breve_status breve_analysis_create(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                             breve_analysis** analysis);

/* NULL is nothing. */
BREVE_API void breve_analysis_destroy(breve_analysis* analysis);

/* The errors and warnings of the program: as breve_runtime_diagnostic_count and breve_runtime_diagnostic. */
BREVE_API size_t breve_analysis_diagnostic_count(const breve_analysis* analysis);
BREVE_API breve_status breve_analysis_diagnostic(const breve_analysis* analysis, size_t index,
                                                 breve_diagnostic* diagnostic);

/* The texts: the main module first, then those that it loads, then the rest of the class library.
   BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API size_t breve_analysis_file_count(const breve_analysis* analysis);
BREVE_API breve_status breve_analysis_file(const breve_analysis* analysis, size_t index, breve_source* file);

/* What a name names. */
typedef enum breve_name_kind {
  BREVE_NAME_MODULE = 0,    /* a file */
  BREVE_NAME_CLASS = 1,     /* also by its other name (aka) */
  BREVE_NAME_METHOD = 2,
  BREVE_NAME_KEYWORD = 3,   /* `to` in `+ to set-velocity to v (vector):` */
  BREVE_NAME_PARAMETER = 4, /* `v` there */
  BREVE_NAME_VARIABLE = 5,  /* of an instance */
  BREVE_NAME_LOCAL = 6,     /* a variable of a method */
  BREVE_NAME_FUNCTION = 7,  /* sqrt and its like */
  BREVE_NAME_CONSTANT = 8,  /* from @define */
  BREVE_NAME_TYPE = 9,      /* int, vector, object ... */
  BREVE_NAME_DIRECTIVE = 10, /* `use` behind an @ */
  BREVE_NAME_WORD = 11      /* another reserved word */
} breve_name_kind;

#define BREVE_NO_SYMBOL ((size_t)-1)

/* Something that a program, the class library or the language gives a name to. No text is NULL. */
typedef struct breve_symbol {
  uint32_t kind;             /* breve_name_kind: from BREVE_NAME_MODULE to BREVE_NAME_CONSTANT */
  const char* name;
  const char* signature;     /* as a reader wants it: "set-velocity to v (vector)", "Mobile : Bird (aka Birds)" */
  const char* type;          /* of a variable, parameter, keyword: "float", "Bird object", "5 ints"; of a method or
                                function: that of its result, "" if it has none or it is not declared */
  const char* value;         /* of a constant, and the default of a keyword, as written; "" if there is none */
  const char* documentation; /* its % lines without the %, of a variable or constant the # comment behind it, of a
                                function one line; "" if it has none */
  const char* owner;         /* the class in whose text it stands; "" outside of classes */
  const char* parent_class;  /* of a class, "" for a root; else "" */
  const char* alias;         /* of a class, its other name or ""; else "" */
  size_t parent;             /* symbol that it is part of: of a method or instance variable the class, of a keyword,
                                parameter or local the method, of a class the module; or BREVE_NO_SYMBOL */
  breve_span name_span;      /* of the name where it is declared */
  breve_span span;           /* of the whole declaration */
  bool library;              /* of the class library, or a function of the language */
  bool loaded;               /* part of the program. False: in a module of the class library that it does not use */
  bool hidden;               /* a method declared with '-' or '=': not meant for others */
} breve_symbol;

/* How many symbols there are: modules, each followed by what it declares in the order of the text, first those of
   the program in order of loading; last the functions. A name that is declared several times is as many symbols. */
BREVE_API size_t breve_analysis_symbol_count(const breve_analysis* analysis);

/* BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below the count. */
BREVE_API breve_status breve_analysis_symbol(const breve_analysis* analysis, size_t index, breve_symbol* symbol);

/* A name at a place. */
typedef struct breve_reference {
  uint32_t kind;         /* breve_name_kind: what the name means there */
  const char* name;
  const char* type;      /* static type of the variable, or class of the receiver of the method or keyword, where they
                            are known: "Bird object"; else "" */
  const char* signature; /* of the symbol; of a reserved word how it is used: "foreach item in list: statement" */
  const char* documentation; /* of the symbol or reserved word; or "" */
  breve_span span;
  size_t symbol;    /* the likeliest, as breve_analysis_definitions; or BREVE_NO_SYMBOL */
  bool declaration; /* the name is declared here */
} breve_reference;

/* Which name stands at a place: in it or just behind it.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such file, no such place, or no name there. */
BREVE_API breve_status breve_analysis_name_at(const breve_analysis* analysis, const char* file, uint32_t line,
                                              uint32_t column, breve_reference* reference);

/* The symbols that the name at a place may mean, best first. A method that is called on a receiver of known class is
   the one found there or in its ancestors; on another receiver, every method of that name that takes the keywords.
   @param symbols  room for `capacity` numbers; NULL only if capacity is 0
   @param count    how many there are, also where that is more than capacity: at most capacity are written
   BREVE_OK, with count 0 if nothing of that name is known; BREVE_ERROR_NOT_FOUND as breve_analysis_name_at. */
BREVE_API breve_status breve_analysis_definitions(const breve_analysis* analysis, const char* file, uint32_t line,
                                                  uint32_t column, size_t* symbols, size_t capacity, size_t* count);

/* The places in the program's files (not the class library's) where a symbol is named, its declaration included, in
   order of files and places. Calls of a method count also where the receiver's class is not known.
   @param spans  room for `capacity`; NULL only if capacity is 0
   @param count  how many there are, also where that is more than capacity: at most capacity are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND if there is no such symbol. */
BREVE_API breve_status breve_analysis_references(const breve_analysis* analysis, size_t symbol, breve_span* spans,
                                                 size_t capacity, size_t* count);

/* The methods that the call around a place may mean, best first, and the keyword whose value stands there. The text
   may be incomplete.
   @param symbols, capacity, count  as breve_analysis_definitions
   @param keyword  may be NULL; "" before the first one; owned by the analysis until the next call of this function
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the place is not behind the selector of a call, or there is
   no such file or place. */
BREVE_API breve_status breve_analysis_callees(const breve_analysis* analysis, const char* file, uint32_t line,
                                              uint32_t column, size_t* symbols, size_t capacity, size_t* count,
                                              const char** keyword);

/* A name that may stand at a place. Texts live until the next call of a completion function on the analysis. */
typedef struct breve_completion {
  uint32_t kind;             /* breve_name_kind */
  const char* name;          /* to be put in the place of what is typed of it */
  const char* detail;        /* the signature of its symbol; of a word how it is used; or "" */
  const char* owner;         /* class that declares it, or "" */
  const char* documentation; /* or "" */
  size_t symbol;             /* or BREVE_NO_SYMBOL */
} breve_completion;

/* The names that may stand at a place, all that begin with what is typed of a name just before it, capitals or not:
   selectors behind a receiver, keywords in a call, classes behind `new`, `all` and in types, variables, constants,
   functions and words where an expression or statement may begin, types behind a '(' of a declaration, directives
   behind an '@', variables behind a `$` in a string. None inside comments. The likeliest come first.
   @param typed  may be NULL: bytes just before the place that the name is to replace
   @param items  room for `capacity`; NULL only if capacity is 0
   @param count  how many there are, also where that is more than capacity: at most capacity are written
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such file or place. */
BREVE_API breve_status breve_analysis_completions(const breve_analysis* analysis, const char* file, uint32_t line,
                                                  uint32_t column, uint32_t* typed, breve_completion* items,
                                                  size_t capacity, size_t* count);

/* The same for a statement that is being typed and is part of no file, as though it stood in a method of a class.
   @param class_name  a class of the program or the class library, name or alias; NULL: none, so that `self` is unknown
   @param text        the statement, `size` bytes; NULL only if size is 0
   @param offset      the place, in bytes; at most size
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no such class; BREVE_ERROR_ARGUMENT: offset beyond size. */
BREVE_API breve_status breve_analysis_statement_completions(const breve_analysis* analysis, const char* class_name,
                                                            const char* text, size_t size, size_t offset,
                                                            uint32_t* typed, breve_completion* items, size_t capacity,
                                                            size_t* count);

#ifdef __cplusplus
}
#endif

#endif
