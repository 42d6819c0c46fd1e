// Archives: which objects belong to one, their order, writing and reading them.
#include "steve/library/archive.hpp"

#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "steve/library/archive_body.hpp"
#include "steve/library/archive_parse.hpp"
#include "steve/library/archive_values.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/library.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

namespace {

constexpr int kVersion = 1;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::File, why); }

/// Variables that are made anew instead of archived: what belongs to the world around the object.
bool is_archived(const ClassInfo& cls, std::string_view name, const VariableInfo& variable) {
  if (variable.array_size >= 0 && variable.type == StaticType::Pointer) return false;
  if (cls.name == "Object") return name == "birthTime" || name == "archiveDependencies";
  if (cls.name == "Real") return name != "realLines" && name != "realMenus" && name != "realWorldPointer";
  if (cls.name == "Control") return name == "accuracyRung";
  if (cls.name == "Spring") return true;
  if (cls.name == "MultiBody") return name != "bodyMenus";
  // A server or a movie that is open belongs to the object that opened it.
  if (cls.name == "NetworkServer") return name != "serverURL";
  if (cls.name == "Movie") return name == "frameCount";
  return variable.type != StaticType::Pointer;
}

/// Calls `visit(class, name, variable)` for every archived variable of an object, root class first.
template <class Visit>
void for_each_variable(Machine& machine, const ClassInfo& concrete, Visit visit) {
  std::vector<const ClassInfo*> classes;
  for (const ClassInfo* cls = &concrete; cls; cls = cls->parent) classes.insert(classes.begin(), cls);
  for (const ClassInfo* cls : classes)
    for (const VariableInfo& variable : cls->variables) {
      const std::string& name = machine.program().symbols().name(variable.name);
      if (is_archived(*cls, name, variable)) visit(*cls, name, variable);
    }
}

bool always_has_body(const Machine& machine, const ClassInfo& cls) {
  for (const char* name : {"Mobile", "Stationary", "Link"}) {
    const ClassInfo* const bodies = machine.program().find_class(name);
    if (bodies && cls.derives_from(*bodies)) return true;
  }
  return false;
}

int elements_of(const VariableInfo& variable) { return variable.array_size >= 0 ? variable.array_size : 1; }

/// One element of an array, or the variable itself, as a variable of its own.
VariableInfo element_of(const VariableInfo& variable, int element) {
  VariableInfo one = variable;
  one.array_size = -1;
  one.slot = variable.slot + static_cast<std::uint32_t>(element * slot_count(variable.type));
  return one;
}

constexpr std::uint64_t kOfByte = 4;  // to read or write one, in elements of a list

// --- writing ---------------------------------------------------------------------------------------------------------

/// What pugixml writes, in a string. A stream of the standard library would hide that memory has run out.
class TextWriter : public pugi::xml_writer {
 public:
  explicit TextWriter(Machine& machine) : machine_(machine) {}
  void write(const void* data, std::size_t size) override {
    if (failure_) return;
    try {
      machine_.charge_for(kOfByte * size);
      text_.append(static_cast<const char*>(data), size);
    } catch (...) {
      failure_ = std::current_exception();  // not through the library: it is not ours
    }
  }
  std::string text() {
    if (failure_) std::rethrow_exception(failure_);
    return std::move(text_);
  }

 private:
  Machine& machine_;
  std::string text_;
  std::exception_ptr failure_;
};

class Writer {
 public:
  explicit Writer(Machine& machine) : machine_(machine) {}

  std::string write(Instance& root) {
    gather(root);
    pugi::xml_document document;
    pugi::xml_node archive = document.append_child("breve-archive");
    archive.append_attribute("version") = kVersion;
    archive.append_attribute("root") = numbers_.at(root.serial);
    ValueWriter values(machine_, numbers_);
    for (Instance* object : order_) {
      if (!object->live())
        throw Error(ErrorCode::Argument, name_of(*object) + " was freed by an archive method of another object");
      write_object(archive.append_child("object"), *object, values);
    }
    TextWriter out(machine_);
    document.save(out, " ");
    return out.text();
  }

 private:
  /// What `object` depends on: what it said, and what its body is made of.
  std::vector<Instance*> needs_of(Instance& object) {
    std::vector<Instance*> needs;
    const Slot* listed = library_slot(machine_, object, "Object", "archiveDependencies");
    if (listed && listed->ref)
      for (const Value& need : *static_cast<ListCell*>(listed->ref))
        if (need.tag == Tag::Object && need.object() && need.object()->live()) needs.push_back(need.object());
    for (const char* name : {"collisionShape", "displayShape", "textureImage", "bitmapImage", "lightmapImage"})
      if (Instance* need = library_object(machine_, object, "Real", name)) needs.push_back(need);
    add_parts(machine_, object, needs);
    return needs;
  }

  /// Depth first without recursion, dependencies before what depends on them. The controller is the world's, not an
  /// object's: it is in an archive only as its root.
  void gather(Instance& root) {
    keep(root);
    std::vector<std::pair<Instance*, bool>> stack{{&root, false}};
    while (!stack.empty()) {
      const auto [object, done] = stack.back();
      stack.pop_back();
      if (done) {
        numbers_.emplace(object->serial, static_cast<int>(order_.size()) + 1);
        order_.push_back(object);
        continue;
      }
      if (!object->live()) continue;  // freed by an archive method since it was found
      if (!met_.insert(object->serial).second || (object == machine_.controller() && object != &root)) continue;
      prepare(*object);
      stack.emplace_back(object, true);
      const std::vector<Instance*> needs = needs_of(*object);
      for (auto need = needs.rbegin(); need != needs.rend(); ++need) {
        keep(**need);
        stack.emplace_back(*need, false);
      }
    }
  }

  /// Archive methods may free anything: what was found stays a cell of its own until the archive is written.
  void keep(Instance& object) {
    if (kept_.insert(object.serial).second) pins_.emplace_back(machine_, Value::of(Tag::Object, &object));
  }

  void prepare(Instance& object) {
    const MethodInfo* hook = machine_.find_method(*object.cls, "archive", 0);
    if (!hook) return;
    const Value answer = machine_.call(object, *hook);
    if (!object.live()) throw Error(ErrorCode::Argument, name_of(object) + " was freed by its archive method");
    if (answer.tag == Tag::Int && answer.i == 0)
      throw Error(ErrorCode::Argument, "archive of " + name_of(object) + " failed");
  }

  void write_object(pugi::xml_node element, Instance& object, ValueWriter& values) {
    element.append_attribute("id") = numbers_.at(object.serial);
    element.append_attribute("class") = object.cls->name.c_str();
    World& world = machine_.world();
    if (const Resource* resource = world.resource(object.id)) {
      ByteWriter out;
      resource->save(out);
      const auto bytes = out.take();
      machine_.charge_for(kOfByte * bytes.size());
      pugi::xml_node native = element.append_child("native");
      native.append_attribute("kind") = std::string(resource->kind()).c_str();
      const std::string text = to_hex({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, machine_.poller());
      machine_.poll();
      native.text() = text.c_str();
    }
    if (world.has_body(object.id)) write_body(machine_, object, element.append_child("body"));
    for_each_variable(machine_, *object.cls, [&](const ClassInfo& cls, const std::string& name, const VariableInfo& v) {
      pugi::xml_node variable = element.append_child("variable");
      variable.append_attribute("class") = cls.name.c_str();
      variable.append_attribute("name") = name.c_str();
      for (int i = 0; i < elements_of(v); ++i) values.write(variable, machine_.get_variable(object, element_of(v, i)));
    });
  }

  Machine& machine_;
  std::deque<Pin> pins_;
  std::set<std::uint64_t> kept_, met_;
  std::map<std::uint64_t, int> numbers_;
  std::vector<Instance*> order_;
};

// --- reading ---------------------------------------------------------------------------------------------------------

pugi::xml_node parse(Machine& machine, pugi::xml_document& document, std::string_view xml) {
  // A hash within a hash is three elements deeper; an archive, an object and a variable are around them.
  constexpr int kDeepest = 3 * kMostNested + 10;
  machine.charge_for(kOfByte * xml.size());
  parse_xml(xml, kDeepest, machine.poller(), document);
  const pugi::xml_node archive = document.child("breve-archive");
  if (!archive) refuse("this is not an archive");
  if (archive.attribute("version").as_int() != kVersion) refuse("this archive is of another version");
  return archive;
}

const ClassInfo& class_of(Machine& machine, pugi::xml_node object) {
  const std::string name = object.attribute("class").value();
  const ClassInfo* cls = machine.program().find_class(name);
  if (!cls) refuse("the archive holds an object of class '" + name + "', which this program does not have");
  return *cls;
}

/// Classes whose objects act outside of the world as soon as they are there: on a network, on files or on the run
/// itself.
bool reaches_outside(const Program& program, const ClassInfo& cls) {
  for (const char* name : {"Control", "File", "GeneticAlgorithm", "Movie", "NetworkServer", "PushClusterGP", "URL"}) {
    const ClassInfo* const outside = program.find_class(name);
    if (outside && cls.derives_from(*outside)) return true;
  }
  return false;
}

/// A value of another type than the variable's is damage, not an error of the program.
void set_from_archive(Machine& machine, Instance& object, const VariableInfo& variable, const Value& value,
                      const std::string& name) {
  try {
    machine.set_variable(object, variable, value);
  } catch (const RunError& error) {
    if (error.kind() != RunErrorKind::Conversion && error.kind() != RunErrorKind::Type) throw;
    refuse("the archive is damaged: variable '" + name + "' of " + object.cls->name + ": " + error.what());
  }
}

/// Calls `visit(class, variable, name, value)` for each variable, or element of an array, that an element has a value
/// for.
template <class Visit>
void read_variables(Machine& machine, const ClassInfo& concrete, pugi::xml_node element, ValueReader& values,
                    Visit visit) {
  std::map<std::pair<std::string, std::string>, pugi::xml_node> written;
  for (const pugi::xml_node variable : element.children("variable")) {
    machine.poll();
    written[{variable.attribute("class").value(), variable.attribute("name").value()}] = variable;
  }
  // A variable that the archive does not have keeps its default: the class may have grown since.
  for_each_variable(machine, concrete, [&](const ClassInfo& cls, const std::string& name, const VariableInfo& v) {
    const auto found = written.find({cls.name, name});
    if (found == written.end()) return;
    int i = 0;
    for (const pugi::xml_node value : found->second.children()) {
      if (value.type() != pugi::node_element || i >= elements_of(v)) continue;
      visit(cls, element_of(v, i++), name, values.read(value));
    }
  });
}

/// A variable, or an element of an array, that an archive has a value for.
struct ArchivedVariable {
  VariableInfo variable;
  std::string name;
};

/// Sets variables to the elements of `values`, or leaves the object as it was.
void set_all_or_none(Machine& machine, Instance& object, const std::vector<ArchivedVariable>& variables,
                     const ListCell& values) {
  ListCell* const before = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, before));
  for (const ArchivedVariable& one : variables)
    machine.heap().push(*before, machine.get_variable(object, one.variable));
  try {
    auto value = values.begin();
    for (const ArchivedVariable& one : variables) {
      set_from_archive(machine, object, one.variable, *value, one.name);
      ++value;
    }
  } catch (...) {
    auto value = before->begin();
    for (const ArchivedVariable& one : variables) {
      if (object.live()) machine.set_variable(object, one.variable, *value);
      ++value;
    }
    throw;
  }
}

class Reader {
 public:
  Reader(Machine& machine, pugi::xml_node archive, Origin origin)
      : machine_(machine), archive_(archive), origin_(origin) {}

  Instance* read() {
    try {
      make_objects();
      if (!objects_.contains(archive_.attribute("root").as_int())) refuse("the archive is damaged: it has no root");
      fill_objects();
      announce_objects();
      for (const auto& [object, rules] : rules_)
        if (object->live()) set_rules(machine_, *object, rules);
    } catch (...) {
      discard_objects();
      throw;
    }
    Instance* const root = objects_.at(archive_.attribute("root").as_int());
    return root->live() ? root : nullptr;
  }

 private:
  /// As the machine makes an instance, but without `init`.
  Instance* make(const ClassInfo& cls) {
    Heap& heap = machine_.heap();
    Instance* object = heap.instance(cls);
    heap.retain(object);
    object->id = machine_.world().create(cls.id, reinterpret_cast<std::uint64_t>(object), cls.iterate != nullptr,
                                         cls.post_iterate != nullptr);
    return object;
  }

  /// Frees what was made. An object that was not announced yet has never lived for the program: it goes without
  /// `destroy`. Once the budget is used up, or the host wants the end, the collector frees the rest later.
  void discard_objects() {
    bool goes_on = true;
    for (const auto& [object, element] : elements_) {
      if (!object || !object->live()) continue;
      if (goes_on) {
        try {
          machine_.poll();
          if (announced_.contains(object))
            machine_.free_instance(*object);
          else
            machine_.discard_instance(*object);
        } catch (...) {  // it comes again at the next call or iteration of a loop
          goes_on = false;
        }
      }
      if (object->live() && !object->auto_free) {
        object->auto_free = true;
        machine_.heap().release(object);
      }
    }
  }

  void make_objects() {
    for (const pugi::xml_node element : archive_.children("object")) {
      machine_.poll();
      const int id = element.attribute("id").as_int();
      if (id <= 0 || objects_.contains(id))
        refuse("the archive is damaged: two objects have the same number, or one has none");
      const ClassInfo& cls = class_of(machine_, element);
      if (origin_ == Origin::Network && reaches_outside(machine_.program(), cls))
        refuse("an object of class '" + cls.name + "' cannot come over the network: it reaches outside of the world");
      elements_.emplace_back(nullptr, element);
      Instance* const object = elements_.back().first = make(cls);
      pins_.emplace_back(machine_, Value::of(Tag::Object, object));
      objects_.emplace(id, object);
    }
  }

  void fill_objects() {
    ValueReader values(machine_, objects_);
    for (const auto& [object, element] : elements_) {
      if (const pugi::xml_node native = element.child("native")) {
        const std::string bytes = from_hex(native.text().get(), machine_.poller());
        ByteReader in(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        try {
          machine_.world().attach(object->id, load_resource(native.attribute("kind").value(), in));
        } catch (const Error& error) {
          if (error.code() != ErrorCode::Image) throw;
          refuse("the archive is damaged: the data of " + name_of(*object) + " cannot be");
        }
      }
      read_variables(
          machine_, *object->cls, element, values,
          [this, target = object](const ClassInfo&, const VariableInfo& variable, const std::string& name,
                                  const Value& value) { set_from_archive(machine_, *target, variable, value, name); });
      if (const pugi::xml_node body = element.child("body")) {
        read_body(machine_, *object, body);
        // A peer does not decide what a class of this world does.
        if (origin_ == Origin::File) rules_.emplace_back(object, read_rules(machine_, *object->cls, body));
      } else if (always_has_body(machine_, *object->cls))
        refuse("the archive is damaged: an object has no body");
    }
  }

  void announce_objects() {
    for (const auto& [object, element] : elements_) {
      if (!object->live()) continue;  // freed by a method of an earlier one
      announced_.insert(object);
      if (const MethodInfo* hook = machine_.find_method(*object->cls, "post-dearchive-set-controller", 0))
        machine_.call(*object, *hook);
      const MethodInfo* hook = object->live() ? machine_.find_method(*object->cls, "dearchive", 0) : nullptr;
      if (!hook) continue;
      const Value answer = machine_.call(*object, *hook);
      if (answer.tag == Tag::Int && answer.i == 0) refuse("dearchive of " + name_of(*object) + " failed");
    }
  }

  Machine& machine_;
  pugi::xml_node archive_;
  Origin origin_;
  std::set<const Instance*> announced_;
  std::vector<std::pair<const Instance*, std::vector<ArchivedRule>>> rules_;
  std::map<int, Instance*> objects_;
  std::vector<std::pair<Instance*, pugi::xml_node>> elements_;
  std::deque<Pin> pins_;  // methods of the objects, and hosts that hear warnings, may free any of them
};

}  // namespace

std::string to_archive(Machine& machine, Instance& root) { return Writer(machine).write(root); }

Instance* from_archive(Machine& machine, std::string_view xml, Origin origin) {
  pugi::xml_document document;
  return Reader(machine, parse(machine, document, xml), origin).read();
}

std::string class_refused_from_network(Machine& machine, std::string_view xml) {
  pugi::xml_document document;
  for (const pugi::xml_node element : parse(machine, document, xml).children("object")) {
    machine.poll();
    const ClassInfo* cls = machine.program().find_class(element.attribute("class").value());
    if (cls && reaches_outside(machine.program(), *cls)) return cls->name;
  }
  return {};
}

void variables_from_archive(Machine& machine, std::string_view xml, Instance& target) {
  pugi::xml_document document;
  const pugi::xml_node archive = parse(machine, document, xml);
  const std::string root = archive.attribute("root").value();
  const pugi::xml_node element = archive.find_child_by_attribute("object", "id", root.c_str());
  if (!element) refuse("the archive is damaged: it has no root");
  const std::string name = element.attribute("class").value();
  if (name != target.cls->name) refuse("the archive holds an object of class '" + name + "', not " + target.cls->name);
  std::vector<ArchivedVariable> variables;
  ListCell* const values = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, values));
  const std::map<int, Instance*> none;
  ValueReader reader(machine, none);
  read_variables(machine, *target.cls, element, reader,
                 [&](const ClassInfo& cls, const VariableInfo& variable, const std::string& name, const Value& value) {
                   if (cls.name == "Object") return;  // it keeps its age and its dependencies
                   variables.push_back({variable, name});
                   machine.heap().push(*values, value);
                 });
  set_all_or_none(machine, target, variables, *values);
}

}  // namespace breve::steve
