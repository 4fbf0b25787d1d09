// SPDX-License-Identifier: GPL-3.0-or-later
// A vector that stores its first elements inline, without an allocation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <type_traits>

namespace eomgen::symbolic {

template <class T, std::uint32_t inside>
class SmallVector {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;
  using const_reverse_iterator = std::reverse_iterator<const T*>;

  SmallVector() noexcept : inside_{} {}
  SmallVector(std::initializer_list<T> items) : inside_{} {
    reserve(items.size());
    for (const T& item : items) new (data() + size_++) T(item);
  }
  SmallVector(const SmallVector& other) : size_(other.size_) {
    if (size_ <= inside && other.capacity_ == inside) {
      copy_inside(other);
      return;
    }
    if (size_ > inside) {
      outside_ = new T[size_];
      capacity_ = size_;
    }
    std::copy_n(other.data(), size_, data());
  }
  SmallVector(SmallVector&& other) noexcept : inside_{} { take(other); }
  SmallVector& operator=(const SmallVector& other) {
    if (this != &other) *this = SmallVector(other);
    return *this;
  }
  SmallVector& operator=(SmallVector&& other) noexcept {
    if (this == &other) return *this;
    release();
    take(other);
    return *this;
  }
  ~SmallVector() { release(); }

  iterator begin() noexcept { return data(); }
  iterator end() noexcept { return data() + size_; }
  const_iterator begin() const noexcept { return data(); }
  const_iterator end() const noexcept { return data() + size_; }
  const_reverse_iterator rbegin() const noexcept { return const_reverse_iterator(end()); }
  const_reverse_iterator rend() const noexcept { return const_reverse_iterator(begin()); }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  T& operator[](std::size_t i) noexcept { return data()[i]; }
  const T& operator[](std::size_t i) const noexcept { return data()[i]; }
  const T& back() const noexcept { return data()[size_ - 1]; }

  void reserve(std::size_t wanted) {
    if (wanted > capacity_) grow(static_cast<std::uint32_t>(wanted));
  }
  void push_back(T item) {
    if (size_ == capacity_) grow(2 * capacity_);
    data()[size_++] = item;
  }
  /// Appends without a check; `reserve` must have made room.
  void push_back_unchecked(T item) noexcept { data()[size_++] = item; }
  /// Keeps the first `count` elements.
  void truncate(std::size_t count) noexcept { size_ = static_cast<std::uint32_t>(count); }

  friend bool operator==(const SmallVector& a, const SmallVector& b) {
    return a.size_ == b.size_ && std::equal(a.begin(), a.end(), b.begin());
  }
  friend bool operator<(const SmallVector& a, const SmallVector& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  T* data() noexcept { return capacity_ == inside ? inside_ : outside_; }
  const T* data() const noexcept { return capacity_ == inside ? inside_ : outside_; }
  void grow(std::uint32_t capacity) {
    T* const wider = new T[capacity];
    std::copy_n(data(), size_, wider);
    release();
    outside_ = wider;
    capacity_ = capacity;
  }
  /// Copies the whole inline storage: its size is known to the compiler.
  void copy_inside(const SmallVector& other) noexcept {
    std::memcpy(static_cast<void*>(inside_), static_cast<const void*>(other.inside_), sizeof(inside_));
  }
  void release() noexcept {
    if (capacity_ != inside) delete[] outside_;
  }
  void take(SmallVector& other) noexcept {
    size_ = other.size_;
    capacity_ = other.capacity_;
    if (capacity_ == inside)
      copy_inside(other);
    else
      outside_ = other.outside_;
    other.size_ = 0;
    other.capacity_ = inside;
  }

  union {
    T inside_[inside];
    T* outside_;
  };
  std::uint32_t size_ = 0, capacity_ = inside;
};

}  // namespace eomgen::symbolic
