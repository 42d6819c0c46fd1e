// Natives of Vector.
#include <algorithm>

#include "steve/library/field_natives.hpp"
#include "steve/library/image_access.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

Instance* set_size(Machine& machine, Instance& self, std::int32_t size) {
  charge_for_making(machine, size);
  resource_made<FieldResource>(machine, self).field = Field::line(size, machine.heap().memory());
  return &self;
}

void init(Machine& machine, Instance& self) {
  constexpr std::int32_t kFirstSize = 3;
  set_size(machine, self, kFirstSize);
}

std::int32_t get_dimension(Machine& machine, Instance& self) { return own_field(machine, self).nx(); }
double get_value(Machine& machine, Instance& self, std::int32_t i) { return own_field(machine, self).get(i); }
void set_value(Machine& machine, Instance& self, double value, std::int32_t i) {
  own_field(machine, self).set(i, 0, 0, value);
}

/// Elements fill the pixels row by row, as far as both go.
template <Channel C>
void copy_to_channel(Machine& machine, Instance& self, Instance* target, double factor) {
  const Field& field = own_field(machine, self);
  Image& picture = image_of(machine, target, "copy-to-channel: the image");
  const auto pixels = static_cast<std::uint64_t>(picture.width()) * static_cast<std::uint64_t>(picture.height());
  machine.charge_for(std::min(pixels, static_cast<std::uint64_t>(field.nx())));
  int i = 0;
  for (int y = 0; y < picture.height() && i < field.nx(); ++y) {
    std::uint8_t* pixel = picture.row(y).data() + static_cast<std::size_t>(C);
    for (int x = 0; x < picture.width() && i < field.nx(); ++x, ++i, pixel += 4)
      *pixel = Field::channel_byte(field.values()[i], factor);
  }
}

constexpr Native kVectorNatives[] = {
    native<init>("vector.init"),
    native<set_size>("vector.init-with"),
    native<set_size>("vector.set-size"),
    native<get_dimension>("vector.get-dimension"),
    native<get_value>("vector.get-value"),
    native<set_value>("vector.set-value"),
    native<fields::set_all_values>("vector.set-all-values"),
    native<fields::get_absolute_sum>("vector.get-absolute-sum"),
    native<fields::add_scalar>("vector.add-scalar"),
    native<fields::scale>("vector.scale"),
    native<fields::add_values>("vector.add-values"),
    native<fields::subtract_values>("vector.subtract-values"),
    native<fields::multiply_with_values>("vector.multiply-with-values"),
    native<fields::transform>("vector.transform"),
    native<fields::copy>("vector.copy"),
    native<copy_to_channel<Channel::Red>>("vector.copy-to-red-channel"),
    native<copy_to_channel<Channel::Green>>("vector.copy-to-green-channel"),
    native<copy_to_channel<Channel::Blue>>("vector.copy-to-blue-channel"),
    native<fields::print_matlab_style>("vector.print-matlab-style"),
};

}  // namespace

std::span<const Native> vector_natives() { return kVectorNatives; }

}  // namespace breve::steve
