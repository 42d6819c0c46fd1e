// What a snapshot keeps of a heap besides its cells: serial numbers, waiting cells, the state of the collector.
#include <algorithm>

#include "steve/machine/heap.hpp"

namespace breve::steve {

void Heap::save_state(ByteWriter& out, const std::function<std::uint64_t(const Cell*)>& number) const {
  out.put(serial_);
  out.put(static_cast<std::uint64_t>(reclaim_at_));
  out.put(static_cast<std::uint64_t>(fresh_bytes_));
  out.put(phase_);
  out.put(static_cast<std::uint8_t>(suspicion_));
  out.put(static_cast<std::uint8_t>(held_by_frames_));
  save_marks(out);
  // The rest of a cut scan, relative to the first element: restored lists start elsewhere in their stores.
  out.put(partial_ == nullptr ? std::uint64_t{0} : number(partial_) + 1);
  std::uint32_t position = position_;
  if (partial_ != nullptr && partial_->tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(*partial_);
    position = position_ > list.first ? position_ - list.first : 0;
  } else if (partial_ != nullptr) {
    const auto& hash = static_cast<const HashCell&>(*partial_);
    position = 0;
    for (std::uint32_t i = 0; i < position_ && i < hash.used; ++i) position += hash.entries[i].live() ? 1U : 0U;
  }
  out.put(position);
  out.put(static_cast<std::uint64_t>(zero_.size()));
  for (const Cell* cell : zero_) out.put(number(cell));
  for (const auto* list : {&doomed_, &condemned_}) {
    out.put(static_cast<std::uint64_t>(list->size()));
    for (const Instance* instance : *list) out.put(number(instance));
  }
  out.put(static_cast<std::uint64_t>(dying_.size()));
  for (const Dying& dying : dying_) out.put(number(dying.instance));
  out.put(share_);
  out.put(slices_left_);
  out.put(far_rest_);
  out.put(next_far_rest_);
  out.put(white_left_);
  out.put(static_cast<std::uint64_t>(suspects_.size()));
  for (const Container* suspect : suspects_) out.put(number(suspect));
  out.put(static_cast<std::uint8_t>(wants_reclaim_));
}

// Only a running collection has marks: 0 white, 1 black, 2 grey.
void Heap::save_marks(ByteWriter& out) const {
  if (phase_ == Phase::Idle) return;
  out.put(passed_);
  for (std::uint32_t slot = 0; slot < marks_.size(); ++slot)
    out.put(static_cast<std::uint8_t>(is_white(slot) ? 0 : marks_[slot] == kGrey ? 2 : 1));
  out.put(static_cast<std::uint64_t>(grey_.size()));
  for (const std::uint32_t slot : grey_) out.put(slot);
}

void Heap::load_marks(ByteReader& in) {
  grey_.clear();
  passed_ = 0;
  white_ = 0;
  for (std::size_t i = 0; i < marks_.size(); ++i) marks_[i] = new_mark(*containers_[i], white_);
  if (phase_ == Phase::Idle) return;
  passed_ = in.get<std::uint32_t>();
  if (passed_ > containers_.size()) ByteReader::fail();
  for (std::uint32_t slot = 0; slot < marks_.size(); ++slot) {
    const auto mark = in.get<std::uint8_t>();
    if (mark > 2) ByteReader::fail();
    if (mark == 1 && is_white(slot)) blacken(slot);
    if (mark == 2) marks_[slot] = kGrey;
  }
  const std::size_t waiting = in.get_count(sizeof(std::uint32_t));
  grey_.reserve(waiting + containers_.capacity());
  for (std::size_t n = waiting; n > 0; --n) grey_.push_back(in.get<std::uint32_t>());
}

void Heap::load_state(ByteReader& in, const std::function<Cell*(std::uint64_t)>& cell) {
  serial_ = in.get<std::uint64_t>();
  reclaim_at_ = static_cast<std::size_t>(in.get<std::uint64_t>());
  fresh_bytes_ = static_cast<std::size_t>(in.get<std::uint64_t>());
  const auto phase = in.get<std::uint8_t>();
  suspicion_ = in.get_bool();
  held_by_frames_ = in.get_bool();
  if (phase > static_cast<std::uint8_t>(Phase::Sweep)) ByteReader::fail();
  phase_ = static_cast<Phase>(phase);
  barrier_ = phase_ != Phase::Idle && phase_ != Phase::Sweep;
  load_marks(in);
  const auto partial = in.get<std::uint64_t>();
  position_ = in.get<std::uint32_t>();
  partial_ = nullptr;
  if (partial != 0) {
    Cell* half_scanned = cell(partial - 1);
    if (half_scanned->tag != Tag::List && half_scanned->tag != Tag::Hash) ByteReader::fail();
    partial_ = static_cast<Container*>(half_scanned);
    if (phase_ == Phase::Sweep) retain(partial_);  // see take_apart
    if (partial_->tag == Tag::List) position_ += static_cast<ListCell*>(partial_)->first;
  }

  for (Cell* waiting : zero_) waiting->listed = false;
  zero_.clear();
  std::size_t unlisted = 0;
  for (std::size_t n = in.get_count(sizeof(std::uint64_t)); n > 0; --n) {
    Cell* waiting = cell(in.get<std::uint64_t>());
    if (waiting->listed) ByteReader::fail();
    enlist(waiting);
  }
  const auto load_instances = [&](auto add) {
    for (std::size_t n = in.get_count(sizeof(std::uint64_t)); n > 0; --n) {
      Cell* instance = cell(in.get<std::uint64_t>());
      if (instance->tag != Tag::Object) ByteReader::fail();
      add(static_cast<Instance*>(instance));
      retain(instance);
    }
  };
  load_instances([this](Instance* instance) { doomed_.push_back(instance); });
  load_instances([this](Instance* instance) { condemned_.push_back(instance); });
  load_instances([this](Instance* instance) { dying_.push_back({instance->serial, instance}); });
  share_ = in.get<std::uint64_t>();
  slices_left_ = in.get<std::uint64_t>();
  far_rest_ = in.get<std::uint8_t>();
  next_far_rest_ = in.get<std::uint8_t>();
  white_left_ = in.get<std::uint64_t>();
  if (phase_ != Phase::Idle && (slices_left_ == 0 || white_left_ > containers_.size())) ByteReader::fail();
  for (std::size_t n = in.get_count(sizeof(std::uint64_t)); n > 0; --n) {
    Cell* held = cell(in.get<std::uint64_t>());
    if (!is_container(held->tag) || held->suspected || suspects_.size() == kMostSuspects) ByteReader::fail();
    suspect(*static_cast<Container*>(held));
  }
  // A cell that nothing refers to and that does not wait would never go: only a damaged image has one.
  wants_reclaim_ = in.get_bool();
  for (const Container* container : containers_) unlisted += container->count == 0 && !container->listed ? 1U : 0U;
  if (unlisted != 0) ByteReader::fail();
}

}  // namespace breve::steve
