// Calls of values, lists and hashes, of variables and methods, and of statements.
#include <array>
#include <cstdint>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_values {

// --- values to pass in -----------------------------------------------------------------------------------------------

breve_status value_null(Caller& c) { return c.keep(breve_value_null()), BREVE_OK; }
breve_status value_int(Caller& c) { return c.keep(breve_value_int(static_cast<std::int32_t>(c.word()))), BREVE_OK; }
breve_status value_double(Caller& c) { return c.keep(breve_value_double(c.number())), BREVE_OK; }
breve_status value_vector(Caller& c) {
  const double x = c.number(), y = c.number();
  return c.keep(breve_value_vector(x, y, c.number())), BREVE_OK;
}
breve_status value_matrix(Caller& c) {
  double rows[9];
  return c.keep(breve_value_matrix(c.numbers(rows, true))), BREVE_OK;
}
breve_status value_string(Caller& c) {
  const breve_value made = breve_value_string(c.chance(20) ? nullptr : "text");
  require(made.type == BREVE_TYPE_STRING && made.as.string.bytes, "a string is invalid");
  return BREVE_OK;
}
breve_status value_object(Caller& c) { return c.keep(breve_value_object(c.any_object(nullptr))), BREVE_OK; }

// --- values of a world -----------------------------------------------------------------------------------------------

/// A value that is passed, or rarely NULL.
struct Passed {
  Passed(Caller& c, const breve_world* world) : Passed(c, c.value(world)) {}
  Passed(Caller& c, const breve_value& passed) : value(passed), null(c.chance(3)) {
    if (null) c.expect_refusal();
  }
  const breve_value* to() const { return null ? nullptr : &value; }
  breve_value value;
  bool null;
};

/// A function that gives a value.
template <class Call>
breve_status get_value(Caller& c, const Call& call) {
  Out<breve_value> value(c);
  const breve_status status = value.after(call(value.to()));
  if (value) c.keep(*value);
  return status;
}

/// A list or hash that was just made, with something in it; else any value.
template <auto kMake>
breve_value container(Caller& c, breve_world* world) {
  breve_value made;
  if (c.chance(40) || kMake(world, &made) != BREVE_OK) return c.value(world);
  const breve_value key = breve_value_int(0), element = c.value(world);
  if constexpr (kMake == breve_list_create)
    breve_list_push(world, &made, &element);
  else
    breve_hash_set(world, &made, &key, &element);
  return made;
}

breve_status value_text(Caller& c) {
  breve_world* world = c.world();
  const Passed value(c, world);
  Out<const char*> text(c);
  const breve_status status = text.after(breve_value_text(world, value.to(), text.to()));
  if (text) read_text(*text);
  return status;
}
breve_status list_create(Caller& c) {
  breve_world* world = c.world();
  return get_value(c, [&](breve_value* to) { return breve_list_create(world, to); });
}
breve_status list_size(Caller& c) {
  breve_world* world = c.world();
  const Passed list(c, container<breve_list_create>(c, world));
  Out<std::size_t> size(c);
  return size.after(breve_list_size(world, list.to(), size.to()));
}
breve_status list_get(Caller& c) {
  breve_world* world = c.world();
  const Passed list(c, container<breve_list_create>(c, world));
  const std::size_t index = c.chance(70) ? c.choose().below(3) : SIZE_MAX;
  return get_value(c, [&](breve_value* to) { return breve_list_get(world, list.to(), index, to); });
}
breve_status random_value(Caller& c) {
  breve_world* world = c.world();
  const Passed bound(c, c.value(world));
  Out<breve_value> drawn(c);
  return drawn.after(breve_world_random(world, bound.to(), drawn.to()));
}
breve_status prepare_super(Caller& c) {
  static constexpr const char* kNames[] = {"Mobile", "Control", "Object", "Nobody"};
  static constexpr const char* kKeywords[] = {"to"};
  breve_world* world = c.world();
  const char* cls = c.text_or_null(c.choose().one_of(kNames));
  const char* method = c.text_or_null(c.chance(50) ? "iterate" : "move");
  Out<breve_selector> selector(c);
  const breve_status status =
      selector.after(breve_world_prepare_super(world, cls, method, kKeywords, c.choose().below(2), selector.to()));
  return status;
}
breve_status list_read(Caller& c) {
  breve_world* world = c.world();
  const Passed list(c, container<breve_list_create>(c, world));
  std::array<breve_value, 3> elements{};
  const std::size_t first = c.chance(90) ? c.choose().below(3) : SIZE_MAX;
  return breve_list_read(world, list.to(), first, c.chance(90) ? elements.data() : nullptr, c.choose().below(4));
}
breve_status list_push(Caller& c) {
  breve_world* world = c.world();
  const Passed list(c, container<breve_list_create>(c, world));
  const Passed element(c, c.chance(10) ? list.value : c.value(world));
  return breve_list_push(world, list.to(), element.to());
}
breve_status hash_create(Caller& c) {
  breve_world* world = c.world();
  return get_value(c, [&](breve_value* to) { return breve_hash_create(world, to); });
}
breve_status hash_size(Caller& c) {
  breve_world* world = c.world();
  const Passed hash(c, container<breve_hash_create>(c, world));
  Out<std::size_t> size(c);
  return size.after(breve_hash_size(world, hash.to(), size.to()));
}
breve_status hash_get(Caller& c) {
  breve_world* world = c.world();
  const Passed hash(c, container<breve_hash_create>(c, world));
  const Passed key(c, c.chance(60) ? breve_value_int(0) : c.value(world));
  return get_value(c, [&](breve_value* to) { return breve_hash_get(world, hash.to(), key.to(), to); });
}
breve_status hash_set(Caller& c) {
  breve_world* world = c.world();
  const Passed hash(c, container<breve_hash_create>(c, world));
  const Passed key(c, world);
  const Passed element(c, c.chance(10) ? hash.value : c.value(world));
  return breve_hash_set(world, hash.to(), key.to(), element.to());
}
breve_status hash_keys(Caller& c) {
  breve_world* world = c.world();
  const Passed hash(c, container<breve_hash_create>(c, world));
  return get_value(c, [&](breve_value* to) { return breve_hash_keys(world, hash.to(), to); });
}

// --- variables and calls ---------------------------------------------------------------------------------------------

/// A variable of the classes in call_programs.
struct Variable {
  const char *name, *type;
};
constexpr Variable kVariables[] = {{"friend", "object"}, {"words", "list"},   {"book", "hash"},  {"turn", "matrix"},
                                   {"bytes", "data"},    {"number", "int"},   {"real", "float"}, {"place", "vector"},
                                   {"name", "string"},   {"marks", "3 ints"}, {"flock", "list"}, {"guest", "object"},
                                   {"papers", "list"},   {"hinge", "object"}, {"nobody", "int"}, {"", "int"}};
constexpr const char* kMethods[] = {"peck", "iterate",     "say",          "recurse", "sprint",
                                    "fail", "vanish",      "fetch",        "talk",    "destroy",
                                    "init", "description", "get-location", "nothing", ""};

breve_status object_get(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Parrot");
  const char* name = c.text_or_null(c.choose().one_of(kVariables).name);
  return get_value(c, [&](breve_value* to) { return breve_object_get(world, object, name, to); });
}
breve_status object_set(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Parrot");
  const Variable& variable = c.choose().one_of(kVariables);
  const char* name = c.text_or_null(variable.name);
  const Passed value(c, c.value_of_type(variable.type, world));
  return breve_object_set(world, object, name, value.to());
}

/// A selector with its arguments: of the programs, or of any class of the library.
struct DrawnCall {
  DrawnCall(Caller& c, const breve_world* world, breve_object object) {
    if (c.chance(40)) {
      method = c.choose().one_of(kMethods);
      if (method == "say")
        for (const char* name : {"to", "text", "times"})
          if (c.chance(80)) keywords.push_back({name, c.value(world)});
    } else {
      from_library(c, world, object);
    }
    if (c.chance(3)) keywords.push_back({c.chance(50) ? nullptr : "nothing", c.value(world)});
  }
  void from_library(Caller& c, const breve_world* world, breve_object object) {
    const ClassLibrary& library = ClassLibrary::get();
    const char* name = breve_object_class(world, object);
    const LibraryClass* cls = name ? library.find(name) : nullptr;
    while (cls && c.chance(40)) cls = library.find(cls->parent);
    if (!cls || c.chance(20)) cls = &c.choose().one_of(library.classes());
    if (cls->selectors.empty()) return;
    const LibrarySelector& selector = c.choose().one_of(cls->selectors);
    method = selector.name;
    for (const LibraryKeyword& keyword : selector.keywords)
      if (!keyword.optional || c.chance(50))
        keywords.push_back({keyword.name.c_str(), c.value_of_type(keyword.type, world)});
    if (c.chance(3) && !keywords.empty()) keywords.pop_back();
  }
  std::string method = "nothing";
  std::vector<breve_keyword> keywords;
};

breve_status object_call(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world);
  const DrawnCall drawn(c, world, object);
  const char* method = c.text_or_null(drawn.method.c_str());
  const breve_keyword* keywords = drawn.keywords.empty() ? nullptr : drawn.keywords.data();
  Out<breve_value> result(c, true);
  const breve_status status =
      result.after(breve_object_call(world, object, method, keywords, drawn.keywords.size(), result.to()));
  if (result) c.keep(*result);
  return status;
}
breve_status world_prepare(Caller& c) {
  static constexpr std::size_t kMostSelectors = 50;
  breve_world* world = c.world();
  const DrawnCall drawn(c, world, c.any_object(world));
  std::vector<const char*> names;
  for (const breve_keyword& keyword : drawn.keywords) names.push_back(keyword.name);
  const char* method = c.text_or_null(drawn.method.c_str());
  Out<breve_selector> selector(c);
  const breve_status status = selector.after(
      breve_world_prepare(world, method, names.empty() ? nullptr : names.data(), names.size(), selector.to()));
  if (!selector) return status;
  const PreparedSelector prepared = {*selector, names.size()};
  if (c.selectors().size() < kMostSelectors)
    c.selectors().push_back(prepared);
  else
    c.selectors()[c.choose().below(kMostSelectors)] = prepared;
  return status;
}
breve_status object_call_prepared(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world);
  PreparedSelector prepared;
  if (c.selectors().empty() || c.chance(5)) {
    prepared.selector.index = c.word();
    prepared.selector.generation = c.word();
  } else {
    prepared = c.choose().one_of(c.selectors());
  }
  if (c.chance(5)) ++prepared.keywords;
  std::vector<breve_value> arguments;
  for (std::size_t i = 0; i < prepared.keywords; ++i) arguments.push_back(c.value(world));
  Out<breve_value> result(c, true);
  const breve_status status = result.after(breve_object_call_prepared(
      world, object, prepared.selector, arguments.empty() ? nullptr : arguments.data(), arguments.size(), result.to()));
  if (result) c.keep(*result);
  return status;
}

// --- statements ------------------------------------------------------------------------------------------------------

constexpr std::string_view kStatements[] = {"1 + 2",
                                            "x = 3. y = { x, x }. y",
                                            "print \"said\", x",
                                            "new Mobile",
                                            "free all Mobiles",
                                            "self iterate",
                                            "while 1: x = 1.",
                                            "return sqrt(-1.0)",
                                            "((",
                                            "\"open",
                                            "for i = 0, i < 3, i++: print i.",
                                            "(new Link) move to (1, 2, 3)",
                                            "words{0} = self",
                                            "nobody fly",
                                            "@use Control.",
                                            ""};

breve_status world_evaluate(Caller& c) {
  breve_world* world = c.world();
  const breve_object self = c.chance(60) ? breve_object{0, 0} : c.object_or_null(world);
  std::string_view text = c.choose().one_of(kStatements);
  if (c.chance(3)) text = {nullptr, 5}, c.expect_refusal();
  Out<breve_value> result(c, true);
  const breve_status status = result.after(breve_world_evaluate(world, self, text.data(), text.size(), result.to()));
  if (result) c.keep(*result);
  return status;
}
breve_status world_session(Caller& c) {
  breve_world* world = c.world();
  return get_value(c, [&](breve_value* to) { return breve_world_session(world, to); });
}
breve_status statements_complete(Caller& c) {
  const std::string_view text = c.choose().one_of(kStatements);
  const bool null = c.chance(10);
  const bool complete = breve_statements_complete(null ? nullptr : text.data(), text.size());
  require(complete || null || !text.empty(), "an empty text is not complete");
  return BREVE_OK;
}

/// The statuses for a value that is passed.
constexpr Statuses kContainer = kType | kStale;

constexpr Function kFunctions[] = {
    {"breve_value_null", value_null},
    {"breve_value_int", value_int},
    {"breve_value_double", value_double},
    {"breve_value_vector", value_vector},
    {"breve_value_matrix", value_matrix},
    {"breve_value_string", value_string},
    {"breve_value_object", value_object},
    {"breve_value_text", value_text, kScript | kValue | kType, 2},
    {"breve_list_create", list_create},
    {"breve_list_size", list_size, kContainer},
    {"breve_list_get", list_get, kContainer | kNotFound},
    {"breve_world_random", random_value, kValue | kType},
    {"breve_world_prepare_super", prepare_super, kNotFound},
    {"breve_list_read", list_read, kContainer | kNotFound},
    {"breve_list_push", list_push, kContainer | kValue, 2},
    {"breve_hash_create", hash_create},
    {"breve_hash_size", hash_size, kContainer},
    {"breve_hash_get", hash_get, kContainer | kNotFound | kValue},
    {"breve_hash_set", hash_set, kContainer | kValue, 2},
    {"breve_hash_keys", hash_keys, kContainer},
    {"breve_object_get", object_get, kVariable, 2},
    {"breve_object_set", object_set, kVariable | kType | kValue, 2},
    {"breve_object_call", object_call, kScript | kValue | kType | kNotFound, 12},
    {"breve_world_prepare", world_prepare, 0, 3},
    {"breve_object_call_prepared", object_call_prepared, kScript | kValue | kType | kNotFound, 4},
    {"breve_world_evaluate", world_evaluate, kScript | kStale | kCompile, 4},
    {"breve_world_session", world_session},
    {"breve_statements_complete", statements_complete, kPlain},
};

}  // namespace call_values

std::span<const Function> value_functions() { return call_values::kFunctions; }

}  // namespace breve::fuzz
