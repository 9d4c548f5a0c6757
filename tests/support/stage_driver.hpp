// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

namespace crisp::test {

/// One stage without a pipeline around it: configured, fed by hand, with its outputs kept.
class StageDriver {
 public:
  template <class S>
  static StageDriver of(const std::map<std::string, OptionValue>& options) {
    return StageDriver(describe_stage<S>(), options);
  }

  void check() const { stage_->check(run_); }

  /// Calls process with these, each a struct that flows or a shared pointer to one.
  template <class... Things>
  void feed(const Things&... things) {
    const std::vector<Item> items{item(things)...};
    Outputs outputs = sink();
    Context context(run_, report_);
    stage_->process(Inputs(items), outputs, context);
  }
  void finish() {
    Outputs outputs = sink();
    Context context(run_, report_);
    stage_->finish(outputs, context);
  }

  /// What was given of a kind, in order.
  template <class T>
  std::vector<std::shared_ptr<const T>> given() const {
    std::vector<std::shared_ptr<const T>> found;
    for (const auto& each : given_) {
      if (auto value = each.as<T>()) found.push_back(std::move(value));
    }
    return found;
  }
  const StageReport& report() const { return report_; }
  RunSettings& run() { return run_; }

 private:
  StageDriver(StageType type, const std::map<std::string, OptionValue>& options)
      : type_(std::move(type)), stage_(type_.make()) {
    for (const auto& [name, value] : options)
      type_.find_option(name)->set(type_.options_object(*stage_), value);
  }

  template <class T>
  static Item item(const T& thing) {
    return Item::of<T>(std::make_shared<const T>(thing));
  }
  template <class T>
  static Item item(const std::shared_ptr<const T>& thing) {
    return Item::of<T>(thing);
  }
  Outputs sink() {
    return Outputs([this](Item each) { given_.push_back(std::move(each)); });
  }

  StageType type_;
  std::unique_ptr<Stage> stage_;
  RunSettings run_;
  StageReport report_;
  std::vector<Item> given_;
};

}  // namespace crisp::test
