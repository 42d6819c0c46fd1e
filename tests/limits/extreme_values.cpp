#include "extreme_values.hpp"

#include <array>

#include "../fuzz/class_library.hpp"

namespace breve::limits {

namespace {

using Texts = std::array<const char*, kOddities>;

constexpr Texts kIntegers = {"2147483647", "(-2147483647 - 1)", "0", "30000", "1000", "-1", "1000000", "1"};
constexpr Texts kReals = {"1.0e308", "-1.0e308", "exp(1000.0)", "sqrt(-1.0)", "1.0e-308", "0.0", "1000000.0", "0.5"};
constexpr Texts kVectors = {"(1.0e308, 1.0e308, 1.0e308)",
                            "(-1.0e308, 0, 1.0e308)",
                            "(0, 0, 0)",
                            "(sqrt(-1.0), 0, 0)",
                            "(1.0e-308, 0, 0)",
                            "(1000000, 1000000, 1000000)",
                            "(1, 1, 1)",
                            "(0.5, 0.25, 0)"};
constexpr Texts kMatrices = {"[ (1.0e308, 0, 0), (0, 1.0e308, 0), (0, 0, 1.0e308) ]",
                             "[ (0, 0, 0), (0, 0, 0), (0, 0, 0) ]",
                             "[ (1, 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (sqrt(-1.0), 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (1.0e-308, 0, 0), (0, 1.0e-308, 0), (0, 0, 1) ]",
                             "[ (1000, 2, 3), (4, 5, 6), (7, 8, 9) ]",
                             "[ (-1, 0, 0), (0, 1, 0), (0, 0, 1) ]",
                             "[ (0, 1, 0), (-1, 0, 0), (0, 0, 1) ]"};
constexpr Texts kStrings = {"long", "\"\"", "xml", "\"big.png\"", "\"out.png\"", "\"Object\"", "\"noise\"", "word"};
constexpr Texts kLists = {"many", "deep", "ring", "tree", "things", "places", "{}", "fitting"};
constexpr Texts kObjects = {"picture", "one", "field", "0", "self", "body", "shape", "peer"};
constexpr Texts kHashes = {"table", "table", "table", "table", "table", "table", "table", "table"};
constexpr Texts kBytes = {"bytes", "bytes", "bytes", "bytes", "bytes", "bytes", "bytes", "bytes"};
constexpr Texts kAny = {"many", "long", "1.0e308", "tree", "one", "deep", "(1.0e308, 0, 0)", "1"};

bool is_type(std::string_view type, std::string_view name) { return type.substr(0, type.find(' ')) == name; }

const Texts& values_of(std::string_view type) {
  if (is_type(type, "int")) return kIntegers;
  if (is_type(type, "float") || is_type(type, "double")) return kReals;
  if (is_type(type, "vector")) return kVectors;
  if (is_type(type, "matrix")) return kMatrices;
  if (is_type(type, "string")) return kStrings;
  if (is_type(type, "list")) return kLists;
  if (is_type(type, "hash")) return kHashes;
  if (is_type(type, "data")) return kBytes;
  if (type.find("object") != std::string_view::npos || fuzz::ClassLibrary::get().find(type)) return kObjects;
  return kAny;
}

/// What one selector takes for a keyword; of functions the keyword is the parameter.
struct OfSelector {
  std::string_view selector, keyword, value;
};
constexpr OfSelector kOfSelectors[] = {
    {"set-accuracy", "to", "\"precise\""},
    {"set-accuracy-setting", "named", "\"step\""},
    {"get-accuracy-setting", "named", "\"step\""},
    {"set-guard", "to", "\"report\""},
    {"set-integrator", "to", "\"runge-kutta-4\""},
    {"set-impact-timing", "to", "\"impact\""},
    {"set-neighborhood", "to", "\"moore\""},
    {"set-update-order", "to", "\"random\""},
    {"set-selection", "to", "\"rank\""},
    {"set-individual-class", "to", "\"Solution\""},
    {"set-force-method", "to", "\"drive-link\""},
    {"set-friction", "static", "0.5"},
    {"follow-shape", "calling", "\"settle\""},
    {"update-states", "with-rule", "\"next-state\""},
    {"update-patches", "with-method", "\"settle\""},
    {"get-argument", "at-index", "0"},
    {"add-layer", "with-neuron-count", "100"},
    {"get-patch-at", "z", "0"},
    {"get-agents-at", "z", "0"},
    {"load-from-obj", "file", "\"mesh.obj\""},
    {"load-from-3ds", "file", "\"mesh.obj\""},
    {"load-hull", "file", "\"mesh.obj\""},
    {"init-with", "scale", "1.0"},
    {"set-line-style", "to", "\"-- -\""},
    {"load", "from", "\"big.png\""},
    {"load", "from-file", "\"sound.wav\""},
    {"open-for-reading", "with-file", "\"lines.txt\""},
    {"openFileForReading", "name", "\"lines.txt\""},
    {"findFile", "name", "\"lines.txt\""},
    {"load-from", "file", "\"data.tz\""},
    {"load-from-xml", "file", "\"data.xml\""},
    {"dearchive-xml", "file", "\"data.xml\""},
    {"read-interpreter-config", "from-file", "\"push.txt\""},
    {"read-config", "from-file", "\"push.txt\""},
    {"configure", "from-text", "\"instruction INTEGER.+\""},
    {"parse", "program", "\"( 1 ( 2 INTEGER.+ ) )\""},
    {"write-graphviz-trace", "for-index", "0"},
    {"set-optimizer", "to", "\"adam\""},
    {"add-instruction", "for-method", "\"settle\""},
    {"add-callback", "for-method", "\"settle\""},
    {"set-skybox-images", "", "{}"},
    {"add-term", "powers", "{ 1 }"},
    {"add-field-term", "powers", "{ 1 }"},
    {"find-on-ray", "of-type", "\"Mobile\""},
    {"find-in-sphere", "with-radius", "1000.0"},
    {"find-in-box", "with-size", "(1000, 1000, 1000)"},
    {"find-near", "within", "1000.0"},
    {"set-population-size", "to", "50"},
    {"set-up", "with-rows", "10"},
    {"set-up", "with-columns", "10"},
    {"createUserSensor", "rows", "10"},
    {"createUserSensor", "columns", "10"},
    {"set-activation-method", "to", "\"identity\""},
    {"set-activation-method", "in-object", "self"},
    {"adopt", "of", "peer"},
    {"join", "with", "peer"},
};

/// What every selector takes for a keyword, or for a parameter of that name.
struct OfName {
  std::string_view name, value;
};
constexpr OfName kOfNames[] = {
    {"of-type", "\"Mobile\""},
    {"with-type", "\"Mobile\""},
    {"className", "\"Mobile\""},
    {"of-class", "\"Mobile\""},
    {"patch-class", "\"Patch\""},
    {"with-patch-class", "\"Patch\""},
    {"with-activation", "\"tanh\""},
    {"decay-type", "\"Linear\""},
    {"theChemical", "chemical"},
    {"of-patch-chemical", "chemical"},
    {"theInterpreter", "interpreter"},
    {"theProgram", "program"},
    {"newProgram", "program"},
    {"otherProgram", "program"},
    {"theGrid", "grid"},
    {"of-patch-grid", "grid"},
    {"otherMatrix", "peer"},
    {"sourceMatrix", "peer"},
    {"firstMatrix", "peer"},
    {"secondMatrix", "peer"},
    {"theMatrix", "field"},
    {"newMatrix", "field"},
    {"newVector", "numbers"},
    {"newShape", "shape"},
    {"theShape", "shape"},
    {"newImage", "picture"},
    {"jointParent", "before"},
    {"child", "link"},
    {"newRoot", "link"},
    {"announcer", "body"},
    {"theInstance", "body"},
    {"newAgent", "body"},
    {"newTarget", "body"},
    {"newOwner", "body"},
    {"fromObject", "body"},
    {"toObject", "body"},
    {"firstObject", "body"},
    {"secondObject", "body"},
    {"typeName", "\"eye\""},
    {"methodName", "\"settle\""},
    {"method-call", "\"settle\""},
    {"with-method", "\"settle\""},
    {"for-method", "\"settle\""},
    {"named", "\"settle\""},
    {"newLimit", "100000"},
    {"angle", "0.5"},
    {"with-density", "1.0"},
    {"newDensity", "1.0"},
    {"at-z", "0"},
};

}  // namespace

std::string odd_value(std::string_view type, std::size_t number) { return values_of(type)[number % kOddities]; }

std::string fitting_value(std::string_view selector, std::string_view keyword, std::string_view parameter,
                          std::string_view type) {
  for (const OfSelector& known : kOfSelectors)
    if (known.selector == selector && (known.keyword == keyword || known.keyword == parameter))
      return std::string(known.value);
  if (is_type(type, "PatchGrid")) return "grid";
  if (is_type(type, "Image")) return "picture";
  if (is_type(type, "Matrix2D")) return "field";
  if (is_type(type, "Matrix3D")) return "cube";
  if (is_type(type, "Vector")) return "numbers";
  if (is_type(type, "Real")) return "body";
  for (const OfName& known : kOfNames)
    if (known.name == keyword || known.name == parameter) return std::string(known.value);
  if (is_type(type, "vector")) return "(0.5, 0.25, 0.125)";
  return odd_value(type, kOddities - 1);
}

}  // namespace breve::limits
