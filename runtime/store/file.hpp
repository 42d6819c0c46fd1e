// A text file as scripts read and write it: line by line or whole. Files beyond 2 GiB are fine.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace breve {

/// Every call throws Error{File} naming the file and the reason; a call on a closed file, or reading what was opened
/// for writing (and the other way about), is such an error too.
class TextFile {
 public:
  enum class Mode { Read, Write, Append };  // Write: an earlier content is lost

  TextFile(std::string path, Mode mode);
  ~TextFile();  // closes; a failure of the last write is then lost: call close to see it
  TextFile(TextFile&&) noexcept;
  TextFile& operator=(TextFile&&) noexcept;

  const std::string& path() const { return path_; }
  bool open() const { return file_ != nullptr; }

  /// The next line without its end ("\n" or "\r\n"); empty at the end of the file. May contain any byte.
  std::string read_line();
  /// What is left of the file.
  std::string read_all();
  /// True only after a read met the end of the file.
  bool is_end() const { return end_; }
  void write(std::string_view text);
  void close();

 private:
  void need(Mode mode, const char* verb) const;
  [[noreturn]] void fail(const char* verb, const char* why) const;

  std::string path_;
  Mode mode_;
  bool end_ = false;
  struct Handle;
  std::unique_ptr<Handle> file_;
};

}  // namespace breve
