// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <mutex>
#include <thread>
#include <utility>

#include <crisp/runner.hpp>

#include "pipeline/data/exception_to_error.hpp"
#include "pipeline/stage/stage_caveats.hpp"
#include "pipeline/stage/stage_worker.hpp"
#include "pipeline/stage/stopwatch.hpp"

namespace crisp {
namespace {

using stage::StageWorker;

class Runner {
 public:
  Runner(Pipeline& pipeline, const RunSettings& run, const RunHooks& hooks)
      : run_(run),
        hooks_(hooks),
        ends_gently_(std::any_of(pipeline.nodes.begin(), pipeline.nodes.end(),
                                 [](const auto& node) { return node.type->endless; })) {
    for (auto& node : pipeline.nodes) add(node);
  }

  std::vector<NodeResult> run() {
    try {
      run_all();
    } catch (const Interrupted&) {
      if (hooks_.failed) hooks_.failed(results());
      throw;
    } catch (const Error&) {
      if (hooks_.failed) hooks_.failed(results());
      if (is_stopped()) throw Interrupted();  // what a stage that stopped halfway complains of is no news
      throw;
    }
    return results();
  }

 private:
  void run_all() {
    std::vector<std::size_t> endless;
    for (const auto source : sources()) {
      if (workers_[source].type().endless) {
        endless.push_back(source);
      } else {
        pull(source);
      }
    }
    if (endless.size() == 1) pull(endless.front());
    if (endless.size() > 1) pull_together(endless);
    for (std::size_t i = 0; i < workers_.size(); ++i) finish(i);
  }

  void pull(std::size_t source) {
    call(source, [](StageWorker& w) { w.node->stage->process(Inputs({}), *w.out, *w.context); });
  }

  /// Each in a thread of its own. What they give runs through the stages below one item after the other.
  void pull_together(const std::vector<std::size_t>& sources) {
    together_ = true;
    std::exception_ptr failure;
    {
      std::vector<std::jthread> threads;
      for (const auto source : sources) {
        threads.emplace_back([&, source] {
          try {
            pull(source);
          } catch (...) {
            const std::lock_guard lock(turn_);
            if (!abandoned_.exchange(true)) failure = std::current_exception();
          }
        });
      }
    }
    together_ = false;
    if (failure) std::rethrow_exception(failure);
  }

  std::vector<NodeResult> results() {
    stage::resolve_caveats(workers_);
    std::vector<NodeResult> list;
    for (auto& worker : workers_) list.push_back(worker.take_result());
    return list;
  }

  void add(PipelineNode& node) {
    const std::size_t index = workers_.size();
    StageWorker& worker = workers_.emplace_back(node);
    worker.out.emplace([this, index](const Item& item) { give(index, item); });
    worker.context.emplace(run_, worker.result.report,
                           !ends_gently_ || node.type->endless ? hooks_.stop : nullptr, progress_of(worker));
    worker.context->watch(status_of(worker), &abandoned_);
    worker.context->set_caveats_above([this, index] { return stage::caveats_above(workers_, index); });
    for (std::size_t i = 0; i < node.type->inputs.size(); ++i) {
      for (const auto feeder : node.feeders[i])
        workers_[feeder].edges.push_back({node.type->inputs[i].kind, index, i});
    }
  }

  /// Sources whose items are only held go first; otherwise the pipeline's order.
  std::vector<std::size_t> sources() const {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (workers_[i].type().is_source()) list.push_back(i);
    }
    std::stable_partition(list.begin(), list.end(), [&](std::size_t i) { return is_only_held(i); });
    return list;
  }

  bool is_only_held(std::size_t index) const {
    const auto& edges = workers_[index].edges;
    return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const StageWorker::Edge& edge) {
      return workers_[edge.to].type().inputs[edge.input].held;
    });
  }

  void deliver(std::size_t to, std::size_t input, Item item) {
    StageWorker& worker = workers_[to];
    ++worker.taken[input];
    const bool held = worker.type().inputs[input].held;
    if (held && !worker.slots[input].value) {
      worker.slots[input] = std::move(item);
      if (worker.is_ready()) replay(to);
    } else if (!worker.is_ready()) {
      worker.waiting.emplace_back(input, std::move(item));
    } else {
      take(to, input, std::move(item));
    }
  }

  void take(std::size_t to, std::size_t input, Item item) {
    StageWorker& worker = workers_[to];
    worker.slots[input] = std::move(item);
    if (worker.type().inputs[input].held) return;
    call(to, [](StageWorker& w) { w.node->stage->process(Inputs(w.slots), *w.out, *w.context); });
    worker.slots[input].value = nullptr;
  }

  void replay(std::size_t index) {
    auto& waiting = workers_[index].waiting;
    while (!waiting.empty()) {
      auto [input, item] = std::move(waiting.front());
      waiting.pop_front();
      take(index, input, std::move(item));
    }
  }

  void finish(std::size_t index) {
    if (!workers_[index].waiting.empty()) throw workers_[index].missing_input();
    call(index, [&](StageWorker& w) {
      w.node->stage->finish(*w.out, *w.context);
      stage::refuse_overwritten(workers_, index);
    });
    for (const auto& edge : workers_[index].edges) {
      StageWorker& fed = workers_[edge.to];
      if (--fed.open[edge.input] == 0 && fed.is_ready()) replay(edge.to);
    }
  }

  void give(std::size_t from, const Item& item) {
    const bool waits_its_turn = together_ && workers_[from].type().endless;
    const auto turn = waits_its_turn ? std::unique_lock(turn_) : std::unique_lock<std::mutex>();
    if (is_stopped() || abandoned_) throw Interrupted();
    StageWorker& worker = workers_[from];
    worker.count_given(item);
    if (hooks_.given) hooks_.given(worker.node->tag, item);
    for (const auto& edge : worker.edges) {
      if (edge.kind == item.kind) deliver(edge.to, edge.input, item);
    }
  }

  /// Calls into a stage: measures its time, and adds its tag and place to what it throws.
  template <class Call>
  void call(std::size_t index, Call&& body) {
    if (is_stopped()) throw Interrupted();
    StageWorker& worker = workers_[index];
    try {
      const bool waits = together_ && worker.type().endless;
      if (waits) {  // the stopwatch is for what takes turns
        body(worker);
      } else {
        const stage::Stopwatch::Turn turn(stopwatch_, worker.result.seconds);
        body(worker);
      }
    } catch (const Interrupted&) {
      throw;
    } catch (const Reported&) {
      throw;
    } catch (const Error& error) {
      const Place& place = error.place().file.empty() ? worker.node->place : error.place();
      throw Reported(worker.node->tag + ": " + error.message(), error.advice(), place);
    } catch (const std::exception& thrown) {
      const Error error = data::error_of(thrown);
      throw Reported(worker.node->tag + ": " + error.message(), error.advice(), worker.node->place);
    } catch (...) {
      throw Reported(worker.node->tag + ": it threw something that is no std::exception",
                     "let it throw crisp::Error", worker.node->place);
    }
    announce_caveats(worker);
    if (is_stopped()) throw Interrupted();
  }

  void announce_caveats(StageWorker& worker) const {
    const auto& caveats = worker.result.report.caveats;
    if (!hooks_.caveat || worker.announced == caveats.size()) return;
    const std::lock_guard lock(reported_);
    for (; worker.announced < caveats.size(); ++worker.announced)
      hooks_.caveat(worker.node->tag, caveats[worker.announced]);
  }

  ProgressSink progress_of(const StageWorker& worker) const {
    if (!hooks_.progress) return {};
    return [this, &worker](const Progress& progress) {
      const std::lock_guard lock(reported_);
      hooks_.progress(worker.node->tag, progress);
    };
  }

  StatusSink status_of(const StageWorker& worker) const {
    if (!hooks_.status) return {};
    return [this, &worker](const StageStatus& status) {
      const std::lock_guard lock(reported_);
      hooks_.status(worker.node->tag, status);
    };
  }

  /// Whether to stop without finishing. Where a source is endless, a stop request is its end instead.
  bool is_stopped() const {
    return !ends_gently_ && hooks_.stop && hooks_.stop->load(std::memory_order_relaxed);
  }

  /// An error that names its stage already: it passes through the stages that feed that one.
  class Reported : public Error {
    using Error::Error;
  };

  const RunSettings& run_;
  const RunHooks& hooks_;
  stage::StageWorkers workers_;
  bool ends_gently_ = false;
  stage::Stopwatch stopwatch_;
  std::atomic<bool> together_ = false;   ///< several sources are being pulled
  std::atomic<bool> abandoned_ = false;  ///< one of them failed
  std::mutex turn_;                      ///< of the source that gives
  mutable std::mutex reported_;          ///< guards the hooks' calls
};

}  // namespace

std::vector<NodeResult> run_pipeline(Pipeline& pipeline, const RunSettings& run, const RunHooks& hooks) {
  return Runner(pipeline, run, hooks).run();
}

}  // namespace crisp
