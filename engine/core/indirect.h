#pragma once
/// Heap value in a struct whose header does not define the value's type. It is copied with the
/// struct and const with it. Like std::indirect of C++26, but `T` may be incomplete where the
/// struct is made and copied. The source that defines `T` includes indirect_definitions.h and
/// instantiates `template class Indirect<T>`.

namespace vinerow {

template <class T>
class Indirect {
 public:
  Indirect();
  explicit Indirect(T value);
  Indirect(const Indirect& other);
  /// Afterwards `other` is empty and may only be assigned to or destroyed.
  Indirect(Indirect&& other) noexcept;
  Indirect& operator=(const Indirect& other);
  Indirect& operator=(Indirect&& other) noexcept;
  Indirect& operator=(T value);
  ~Indirect();

  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return value_; }
  const T* operator->() const { return value_; }
  operator T&() { return *value_; }
  operator const T&() const { return *value_; }

 private:
  T* value_;
};

}  // namespace vinerow
