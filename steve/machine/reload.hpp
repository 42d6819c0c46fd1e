// A changed program in the place of the running one, in a world that goes on living.
//
// The whole heap is written anew under the new program's classes, beside the old one, and takes its place when all went
// well: so whatever fails, be it for want of memory in the middle, leaves nothing changed. Objects keep their ids,
// serial numbers and places in every order, and with an unchanged program the new heap is the old one bit for bit.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "steve/machine/machine.hpp"

namespace breve::steve {

class Reload {
 public:
  Reload(Machine& machine, std::shared_ptr<const Program> program);
  /// Do it, or throw Error{Reload} with the reason, and change nothing.
  /// @return  what may surprise: variables that could not keep their value
  std::vector<std::string> run();

 private:
  /// Where the value of a variable comes from. `from` is null for a new one.
  struct Move {
    const VariableInfo* from;
    const VariableInfo* to;
    bool converts;  // the type is another one
  };
  struct Layout {
    std::vector<Move> moves;
    std::vector<const VariableInfo*> dropped;  // old ones without successor, those that convert among them
  };

  void find_classes();
  void check_object_class(const ClassInfo& from, std::size_t objects) const;
  void check_controller() const;
  const ClassInfo& class_of(const Instance& instance) const;
  const Layout& layout(const ClassInfo& from);
  void number_cells();
  void number(const Cell* cell);
  void make_containers();
  void make_others();
  Cell* make_other(const Cell& cell);
  void fill(const Container& cell);
  void fill(const Instance& from, Instance& to);
  void copy(const Move& move, const Instance& from, Instance& to);
  void drop(const Slot* slots, std::uint32_t count);
  void carry_state();
  void convert_variables();
  void convert(const Move& move, const Instance& from, Instance& to);
  void write(Slot* to, StaticType type, const Value& value, const std::string& what);
  bool accepts(const VariableInfo& variable, const Cell* object) const;
  void warn(const ClassInfo& cls, const VariableInfo& variable, const std::string& why);
  Cell* twin(const Cell* cell) const { return cell ? twins_[numbers_.at(cell)] : nullptr; }
  Value twin(const Value& v) const { return v.is_reference() ? Value::of(v.tag, twin(v.ref)) : v; }
  void exchange();

  Machine& machine_;
  std::shared_ptr<const Program> program_;
  std::unique_ptr<Heap> heap_;
  std::pmr::vector<StringCell*> strings_;
  std::vector<const ClassInfo*> classes_;                      // by old number; null: gone
  std::unordered_map<const ClassInfo*, Layout> layouts_;       // looked up only
  std::pmr::unordered_map<const Cell*, std::size_t> numbers_;  // looked up only
  std::pmr::vector<const Cell*> cells_;                        // old ones: containers first, then what they refer to
  std::pmr::vector<Cell*> twins_;                              // the same, new
  std::size_t containers_ = 0;
  std::pmr::vector<Cell*> dropped_;  // new cells that a variable without successor referred to
  std::vector<std::string> warnings_;
};

}  // namespace breve::steve
