// Files as scripts see them: lines and whole texts through a pointer.
#include <array>
#include <memory>

#include "steve/machine/files.hpp"
#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

/// A file that is open for reading or for writing, or closed.
class FilePointer final : public NativePointer {
 public:
  explicit FilePointer(std::unique_ptr<FileReader> reader) : reader_(std::move(reader)) {}
  explicit FilePointer(std::unique_ptr<FileWriter> writer) : writer_(std::move(writer)) {}

  FileReader& reader() const {
    if (!reader_) Machine::fail(RunErrorKind::Type, writer_ ? "this file was opened for writing" : kClosed);
    return *reader_;
  }
  FileWriter& writer() const {
    if (!writer_) Machine::fail(RunErrorKind::Type, reader_ ? "this file was opened for reading" : kClosed);
    return *writer_;
  }
  void close() {
    reader_.reset();
    if (const auto writer = std::move(writer_)) writer->close();
  }

  /// The next byte, -1 at the end.
  int next() {
    if (at_ == size_) {
      at_ = 0;
      size_ = reader().read(block_.data(), block_.size());
      end_ = size_ == 0;
    }
    return end_ ? -1 : static_cast<unsigned char>(block_[at_++]);
  }
  bool end() const { return end_; }

 private:
  static constexpr const char* kClosed = "this file is closed";

  std::unique_ptr<FileReader> reader_;
  std::unique_ptr<FileWriter> writer_;
  std::array<char, 4096> block_;
  std::size_t at_ = 0, size_ = 0;
  bool end_ = false;
};

FilePointer& file_of(PointerCell* pointer) {
  if (pointer == nullptr)
    throw RunError(RunErrorKind::Type, "this file was not opened: the pointer is null",
                   "opening returns null if the file does not exist or may not be read: test the pointer with 'if'");
  auto* file = dynamic_cast<FilePointer*>(pointer->native.get());
  if (file == nullptr) Machine::fail(RunErrorKind::Type, "this pointer is not an open file");
  return *file;
}

/// NULL if it cannot be opened: with a warning unless there is no such file, which the program is to find out.
template <class Open>
PointerCell* open_file(Machine& machine, std::string_view name, Open open) {
  try {
    return machine.heap().pointer(std::make_unique<FilePointer>(open()));
  } catch (const MissingFile&) {
    return nullptr;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    machine.warn_once("file:" + std::string(name), error.what());
    return nullptr;
  }
}

PointerCell* open_to_read(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_reading(machine, view(name)); });
}
PointerCell* open_to_write(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_writing(machine, view(name), false); });
}
PointerCell* open_to_append(Machine& machine, Instance&, StringCell* name) {
  return open_file(machine, view(name), [&] { return open_for_writing(machine, view(name), true); });
}

void need_room(std::size_t size) {
  if (size >= kMostFileBytes)
    Machine::fail(RunErrorKind::Bounds, "the text that is read from this file is longer than 256 MiB");
}

/// One line without its end, which may be "\n" or "\r\n".
std::string line_of(FilePointer& file) {
  std::string line;
  for (int c = file.next(); c != -1 && c != '\n'; c = file.next()) {
    need_room(line.size());
    line += static_cast<char>(c);
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

StringCell* read_line(Machine& machine, Instance&, PointerCell* pointer) {
  return machine.heap().string(line_of(file_of(pointer)));
}

StringCell* read_whole(Machine& machine, Instance&, PointerCell* pointer) {
  FilePointer& file = file_of(pointer);
  constexpr std::size_t kBytesPerPoll = 65536;
  std::string text;
  for (int c = file.next(); c != -1; c = file.next()) {
    need_room(text.size());
    if (text.size() % kBytesPerPoll == 0) machine.poll();
    text += static_cast<char>(c);
  }
  return machine.heap().string(text);
}

void push_text(Heap& heap, ListCell& list, std::string_view text) {
  heap.push(list, Value::of(Tag::String, heap.string(text)));
}

/// Split at every delimiter, which may be several bytes long; none: the line is the only element. "" gives {}.
ListCell* read_delimited(Machine& machine, Instance&, PointerCell* pointer, StringCell* delimiter) {
  const std::string line = line_of(file_of(pointer));
  const std::string_view cut = view(delimiter);
  ListCell* list = machine.heap().list();
  if (line.empty()) return list;
  std::size_t start = 0;
  for (auto at = cut.empty() ? std::string::npos : line.find(cut); at != std::string::npos;
       at = line.find(cut, start)) {
    push_text(machine.heap(), *list, std::string_view(line).substr(start, at - start));
    start = at + cut.size();
  }
  push_text(machine.heap(), *list, std::string_view(line).substr(start));
  return list;
}

ListCell* read_words(Machine& machine, Instance&, PointerCell* pointer) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  const std::string line = line_of(file_of(pointer));
  ListCell* list = machine.heap().list();
  for (auto start = line.find_first_not_of(kBlanks); start != std::string::npos;) {
    const auto end = line.find_first_of(kBlanks, start);
    push_text(machine.heap(), *list, std::string_view(line).substr(start, end - start));
    start = end == std::string::npos ? end : line.find_first_not_of(kBlanks, end);
  }
  return list;
}

void write_string(Machine& machine, Instance&, PointerCell* pointer, StringCell* text) {
  FileWriter& file = file_of(pointer).writer();
  try {
    file.write(view(text));
  } catch (const Error& error) {
    machine.warn(std::string("writeString: the text could not be written completely: ") + error.what());
  }
}

std::int32_t at_end(Machine&, Instance&, PointerCell* pointer) { return file_of(pointer).end() ? 1 : 0; }

void close_file(Machine& machine, Instance&, PointerCell* pointer) {
  if (pointer == nullptr) return;
  try {
    file_of(pointer).close();
  } catch (const Error& error) {
    machine.warn(std::string("closeFile: ") + error.what());
  }
}

constexpr std::array kFileFunctions = {
    native<open_to_read>("openFileForReading", Reach::Reads),
    native<open_to_write>("openFileForWriting", Reach::Writes),
    native<open_to_append>("openFileForAppending", Reach::Writes),
    native<read_line>("readLine"),
    native<read_whole>("readFileAsString"),
    native<read_delimited>("readDelimitedList"),
    native<read_words>("readWhitespaceDelimitedList"),
    native<write_string>("writeString"),
    native<at_end>("fileEOF"),
    native<close_file>("closeFile"),
};

}  // namespace

std::span<const Native> file_functions() { return kFileFunctions; }

}  // namespace breve::steve
