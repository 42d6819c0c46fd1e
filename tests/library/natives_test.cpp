// Every @native name is bound, with the signature that its declaration promises, and no native is bound in vain.
#include <set>

#include "steve/library/library.hpp"
#include "tests/library/parsed_library.hpp"

namespace breve::steve {
namespace {

char letter(const ast::TypeRef& type) {
  switch (type.kind) {
    case ast::TypeKind::Int: return 'i';
    case ast::TypeKind::Double: return 'd';
    case ast::TypeKind::Vector: return 'v';
    case ast::TypeKind::Matrix: return 'm';
    case ast::TypeKind::String: return 's';
    case ast::TypeKind::Object: return 'o';
    case ast::TypeKind::List: return 'l';
    case ast::TypeKind::Hash: return 'h';
    case ast::TypeKind::Pointer: return 'p';
    case ast::TypeKind::Data: return 'b';
  }
  return '?';
}

/// Class, method and declared signature of every native method; "?" stands for a result without a declared type.
struct Declared {
  std::string where, native, parameters;
  char result;
};

std::vector<Declared> declared_natives() {
  std::vector<Declared> all;
  for (const ast::File& file : ParsedLibrary::get().files)
    for (const ast::Class& cls : file.classes)
      for (const ast::Method& method : cls.methods) {
        if (!method.native) continue;
        Declared one{cls.name + " " + method.name, *method.native, "", '?'};
        for (const ast::Parameter& parameter : method.parameters) one.parameters += letter(parameter.type);
        if (method.native_result) one.result = letter(*method.native_result);
        all.push_back(one);
      }
  return all;
}

const Native* find_native(const std::string& name) {
  for (const Native& native : library_natives())
    if (native.name == name) return &native;
  return nullptr;
}

TEST(Natives, EveryDeclarationIsBoundWithTheSameSignature) {
  const std::vector<Declared> declared = declared_natives();
  ASSERT_GT(declared.size(), 200U);
  for (const Declared& one : declared) {
    SCOPED_TRACE(one.where);
    const Native* native = find_native(one.native);
    if (!native) {
      ADD_FAILURE() << "'" << one.native << "' is not bound";
      continue;
    }
    const std::size_t colon = native->signature.find(':');
    EXPECT_EQ(native->signature.substr(0, colon), one.parameters);
    const char result = native->signature.at(colon + 1);
    if (one.result == '?')
      EXPECT_TRUE(result == 'n' || result == 'a') << result;
    else
      EXPECT_EQ(result, one.result);
  }
}

TEST(Natives, EveryNativeIsDeclaredAndBoundOnce) {
  std::set<std::string> declared, bound;
  for (const Declared& one : declared_natives()) declared.insert(one.native);
  for (const Native& native : library_natives()) {
    EXPECT_TRUE(declared.contains(std::string(native.name))) << native.name << " is declared nowhere";
    EXPECT_TRUE(bound.insert(std::string(native.name)).second) << native.name << " is bound twice";
  }
}

}  // namespace
}  // namespace breve::steve
