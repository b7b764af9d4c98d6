#pragma once
/// Definitions of Indirect's members, for the one source that instantiates it for a type.

#include <utility>

#include "engine/core/indirect.h"

namespace vinerow {

template <class T>
Indirect<T>::Indirect() : value_(new T()) {}

template <class T>
Indirect<T>::Indirect(T value) : value_(new T(std::move(value))) {}

template <class T>
Indirect<T>::Indirect(const Indirect& other) : value_(new T(*other.value_)) {}

template <class T>
Indirect<T>::Indirect(Indirect&& other) noexcept : value_(std::exchange(other.value_, nullptr)) {}

template <class T>
Indirect<T>& Indirect<T>::operator=(const Indirect& other) {
  Indirect copy(other);
  std::swap(value_, copy.value_);
  return *this;
}

template <class T>
Indirect<T>& Indirect<T>::operator=(Indirect&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

template <class T>
Indirect<T>& Indirect<T>::operator=(T value) {
  *value_ = std::move(value);
  return *this;
}

template <class T>
Indirect<T>::~Indirect() {
  delete value_;
}

}  // namespace vinerow
