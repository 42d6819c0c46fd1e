// Natives of Matrix2D and Matrix3D.
#include <algorithm>

#include "steve/library/field_natives.hpp"
#include "steve/library/image_access.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

// --- Matrix2D --------------------------------------------------------------------------------------------------------

Instance* plane_set_size(Machine& machine, Instance& self, std::int32_t nx, std::int32_t ny) {
  charge_for_making(machine, nx, ny);
  resource_made<FieldResource>(machine, self).field = Field::plane(nx, ny, machine.heap().memory());
  return &self;
}

/// 0 for a matrix that has no size yet.
template <int (Field::*Size)() const>
std::int32_t dimension(Machine& machine, Instance& self) {
  const FieldResource* resource = resource_of<FieldResource>(machine, &self);
  return resource && resource->field ? ((*resource->field).*Size)() : 0;
}

double plane_get_value(Machine& machine, Instance& self, std::int32_t x, std::int32_t y) {
  return own_field(machine, self).get(x, y);
}

void plane_set_value(Machine& machine, Instance& self, double value, std::int32_t x, std::int32_t y) {
  own_field(machine, self).set(x, y, 0, value);
}

double plane_get_max_value(Machine& machine, Instance& self) {
  return whole_field(machine, self).max(machine.poller());
}

/// Element (x, y, z) to pixel (x, y), as far as both go.
void copy_plane(Machine& machine, const Field& field, int z, Instance* target, double factor, Channel channel) {
  Image& picture = image_of(machine, target, "copy-to-channel: the image");
  const int width = std::min(picture.width(), field.nx());
  const int height = std::min(picture.height(), field.ny());
  if (width == 0) return;
  machine.charge_for(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height));
  const double* const values = field.values().data();
  const auto column = static_cast<std::ptrdiff_t>(field.ny()) * field.nz();
  for (int y = 0; y < height; ++y) {
    const double* value = values + static_cast<std::ptrdiff_t>(y) * field.nz() + z;
    std::uint8_t* pixel = picture.row(y).data() + static_cast<std::size_t>(channel);
    for (int x = 0; x < width; ++x, value += column, pixel += 4) *pixel = Field::channel_byte(*value, factor);
  }
}

template <Channel C>
void plane_copy_to_channel(Machine& machine, Instance& self, Instance* target, double factor) {
  copy_plane(machine, own_field(machine, self), 0, target, factor, C);
}

// --- Matrix3D --------------------------------------------------------------------------------------------------------

Instance* space_set_size(Machine& machine, Instance& self, std::int32_t nx, std::int32_t ny, std::int32_t nz) {
  charge_for_making(machine, nx, ny, nz);
  resource_made<FieldResource>(machine, self).field = Field::space(nx, ny, nz, machine.heap().memory());
  return &self;
}

double space_get_value(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t z) {
  return own_field(machine, self).get(x, y, z);
}

void space_set_value(Machine& machine, Instance& self, double value, std::int32_t x, std::int32_t y, std::int32_t z) {
  own_field(machine, self).set(x, y, z, value);
}

template <Channel C>
void space_copy_slice(Machine& machine, Instance& self, std::int32_t z, Instance* target, double factor) {
  const Field& field = own_field(machine, self);
  if (z < 0 || z >= field.nz())
    throw Error(ErrorCode::Argument,
                "plane " + std::to_string(z) + " is outside a matrix of " + std::to_string(field.nz()) + " planes");
  copy_plane(machine, field, z, target, factor, C);
}

constexpr Native kMatrixNatives[] = {
    native<plane_set_size>("matrix2d.init-with"),
    native<plane_set_size>("matrix2d.set-size"),
    native<dimension<&Field::nx>>("matrix2d.get-x-dimension"),
    native<dimension<&Field::ny>>("matrix2d.get-y-dimension"),
    native<plane_get_value>("matrix2d.get-value"),
    native<plane_set_value>("matrix2d.set-value"),
    native<fields::set_all_values>("matrix2d.set-all-values"),
    native<fields::get_absolute_sum>("matrix2d.get-absolute-sum"),
    native<plane_get_max_value>("matrix2d.get-max-value"),
    native<fields::add_scalar>("matrix2d.add-scalar"),
    native<fields::scale>("matrix2d.scale"),
    native<fields::add_values>("matrix2d.add-values"),
    native<fields::subtract_values>("matrix2d.subtract-values"),
    native<fields::multiply_with_values>("matrix2d.multiply-with-values"),
    native<fields::transform>("matrix2d.transform"),
    native<fields::copy>("matrix2d.copy"),
    native<fields::add_product>("matrix2d.add-product"),
    native<fields::diffuse_in_place>("matrix2d.diffuse"),
    native<fields::diffuse_periodically>("matrix2d.diffuse-periodically"),
    native<fields::compute_diffusion>("matrix2d.compute-diffusion-matrix"),
    native<fields::compute_periodic_diffusion>("matrix2d.compute-periodic-diffusion-matrix"),
    native<plane_copy_to_channel<Channel::Red>>("matrix2d.copy-to-red-channel"),
    native<plane_copy_to_channel<Channel::Green>>("matrix2d.copy-to-green-channel"),
    native<plane_copy_to_channel<Channel::Blue>>("matrix2d.copy-to-blue-channel"),
    native<fields::print_matlab_style>("matrix2d.print-matlab-style"),
    native<space_set_size>("matrix3d.init-with"),
    native<space_set_size>("matrix3d.set-size"),
    native<space_get_value>("matrix3d.get-value"),
    native<space_set_value>("matrix3d.set-value"),
    native<fields::set_all_values>("matrix3d.set-all-values"),
    native<fields::get_absolute_sum>("matrix3d.get-absolute-sum"),
    native<fields::add_scalar>("matrix3d.add-scalar"),
    native<fields::scale>("matrix3d.scale"),
    native<fields::add_values>("matrix3d.add-values"),
    native<fields::subtract_values>("matrix3d.subtract-values"),
    native<fields::multiply_with_values>("matrix3d.multiply-with-values"),
    native<fields::copy>("matrix3d.copy"),
    native<fields::add_product>("matrix3d.add-product"),
    native<fields::diffuse_in_place>("matrix3d.diffuse"),
    native<fields::diffuse_periodically>("matrix3d.diffuse-periodically"),
    native<fields::compute_diffusion>("matrix3d.compute-diffusion-matrix"),
    native<fields::compute_periodic_diffusion>("matrix3d.compute-periodic-diffusion-matrix"),
    native<space_copy_slice<Channel::Red>>("matrix3d.copy-slice-to-red-channel"),
    native<space_copy_slice<Channel::Green>>("matrix3d.copy-sliced-to-green-channel"),
    native<space_copy_slice<Channel::Blue>>("matrix3d.copy-slice-to-blue-channel"),
    native<space_copy_slice<Channel::Alpha>>("matrix3d.copy-slice-to-alpha-channel"),
};

}  // namespace

std::span<const Native> matrix_natives() { return kMatrixNatives; }

}  // namespace breve::steve
