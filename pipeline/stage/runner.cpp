// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <deque>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include <crisp/runner.hpp>

#include "pipeline/data/resource_exhaustion.hpp"
#include "pipeline/stage/stopwatch.hpp"

namespace crisp {
namespace {

/// One stage at work: its inputs' latest items, and what waits for those that are not there yet.
struct Worker {
  PipelineNode* node = nullptr;
  NodeResult result;
  std::vector<Item> slots;           ///< one an input, with a null value where nothing is there
  std::vector<std::size_t> open;     ///< for each input, how many of its feeders have not finished
  std::vector<std::uint64_t> taken;  ///< for each input, how many items came
  std::vector<std::uint64_t> given;  ///< for each of the type's outputs, how many went
  std::deque<std::pair<std::size_t, Item>> waiting;  ///< (input, item) in order of arrival
  /// (output kind, worker, input) of everything that this one feeds
  struct Edge {
    Kind kind;
    std::size_t to;
    std::size_t input;
  };
  std::vector<Edge> edges;
  std::size_t announced = 0;   ///< of its caveats
  std::optional<Outputs> out;  ///< what each call is given, as is the context
  std::optional<Context> context;
};

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
      if (workers_[source].node->type->endless) {
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
    call(source, [](Worker& w) { w.node->stage->process(Inputs({}), *w.out, *w.context); });
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
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      for (const auto& [kind, why] : workers_[i].result.report.lifted) resolve_caveats(i, kind, why);
    }
    std::vector<NodeResult> list;
    for (auto& worker : workers_) {
      const StageType& type = *worker.node->type;
      for (std::size_t i = 0; i < type.inputs.size(); ++i)
        add(worker.result.taken, type.inputs[i].kind, worker.taken[i]);
      for (std::size_t i = 0; i < type.outputs.size(); ++i)
        add(worker.result.given, type.outputs[i], worker.given[i]);
      list.push_back(std::move(worker.result));
    }
    return list;
  }

  /// The stages all of whose items of this kind ended in what one stage gave in their place: stages feed such
  /// as come behind them only.
  std::vector<std::size_t> replaced_by(std::size_t by, const std::string& kind) const {
    std::vector<bool> replaced(workers_.size(), false);
    replaced[by] = true;
    std::vector<std::size_t> list;
    for (std::size_t i = by; i-- > 0;) {
      std::size_t fed = 0;
      bool elsewhere = false;
      for (const auto& edge : workers_[i].edges) {
        if (edge.kind.name() != kind) continue;
        ++fed;
        elsewhere = elsewhere || !replaced[edge.to];
      }
      replaced[i] = fed > 0 && !elsewhere;
      if (replaced[i]) list.push_back(i);
    }
    return list;
  }

  /// Turns the caveats that one stage answers into warnings.
  void resolve_caveats(std::size_t by, const std::string& kind, const std::string& why) {
    std::string answer = "; " + workers_[by].result.tag;
    answer += ": " + why;
    for (const std::size_t i : replaced_by(by, kind)) {
      StageReport& report = workers_[i].result.report;
      for (std::string& caveat : std::exchange(report.caveats, {})) {
        caveat += answer;
        report.warnings.push_back(std::move(caveat));
      }
    }
  }

  /// Unresolved caveats of the stages above, on items that reach this one.
  std::vector<std::string> caveats_above(std::size_t index) const {
    std::vector<bool> answered(workers_.size(), false);
    for (std::size_t by = 0; by < workers_.size(); ++by) {
      for (const auto& [kind, why] : workers_[by].result.report.lifted) {
        for (const std::size_t i : replaced_by(by, kind)) answered[i] = true;
      }
    }
    std::vector<bool> feeds(workers_.size(), false);
    feeds[index] = true;
    for (std::size_t i = index; i-- > 0;) {
      feeds[i] = std::ranges::any_of(workers_[i].edges, [&](const auto& edge) { return feeds[edge.to]; });
    }
    std::vector<std::string> caveats;
    for (std::size_t i = 0; i < index; ++i) {
      if (feeds[i] && !answered[i])
        std::ranges::copy(workers_[i].result.report.caveats, std::back_inserter(caveats));
    }
    return caveats;
  }

  static void add(std::map<std::string, std::uint64_t>& items, const Kind& kind, std::uint64_t n) {
    if (n > 0) items[std::string(kind.name())] += n;
  }

  void add(PipelineNode& node) {
    const std::size_t index = workers_.size();
    Worker& worker = workers_.emplace_back();
    worker.node = &node;
    worker.result.tag = node.tag;
    worker.result.stage = node.type->name;
    worker.taken.resize(node.type->inputs.size());
    worker.given.resize(node.type->outputs.size());
    worker.out.emplace([this, index](const Item& item) { give(index, item); });
    worker.context.emplace(run_, worker.result.report,
                           !ends_gently_ || node.type->endless ? hooks_.stop : nullptr, progress_of(worker));
    worker.context->watch(status_of(worker), &abandoned_);
    worker.context->set_caveats_above([this, index] { return caveats_above(index); });
    for (std::size_t i = 0; i < node.type->inputs.size(); ++i) {
      const Kind kind = node.type->inputs[i].kind;
      worker.slots.push_back({kind, nullptr});
      worker.open.push_back(node.feeders[i].size());
      for (const auto feeder : node.feeders[i]) workers_[feeder].edges.push_back({kind, index, i});
    }
  }

  /// Sources whose items are only held go first; otherwise the pipeline's order.
  std::vector<std::size_t> sources() const {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (workers_[i].node->type->is_source()) list.push_back(i);
    }
    std::stable_partition(list.begin(), list.end(), [&](std::size_t i) { return is_only_held(i); });
    return list;
  }

  bool is_only_held(std::size_t index) const {
    const auto& edges = workers_[index].edges;
    return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const Worker::Edge& edge) {
      return workers_[edge.to].node->type->inputs[edge.input].held;
    });
  }

  /// Whether the stage can run: everything that it holds is there, or will never come and is optional.
  static bool is_ready(const Worker& worker) {
    for (std::size_t i = 0; i < worker.slots.size(); ++i) {
      const StageInput& input = worker.node->type->inputs[i];
      if (input.held && !worker.slots[i].value && (input.required || worker.open[i] > 0)) return false;
    }
    return true;
  }

  void deliver(std::size_t to, std::size_t input, Item item) {
    Worker& worker = workers_[to];
    ++worker.taken[input];
    const bool held = worker.node->type->inputs[input].held;
    if (held && !worker.slots[input].value) {
      worker.slots[input] = std::move(item);
      if (is_ready(worker)) replay(to);
    } else if (!is_ready(worker)) {
      worker.waiting.emplace_back(input, std::move(item));
    } else {
      take(to, input, std::move(item));
    }
  }

  void take(std::size_t to, std::size_t input, Item item) {
    Worker& worker = workers_[to];
    worker.slots[input] = std::move(item);
    if (worker.node->type->inputs[input].held) return;
    call(to, [](Worker& w) { w.node->stage->process(Inputs(w.slots), *w.out, *w.context); });
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
    if (!workers_[index].waiting.empty()) throw never_came(workers_[index]);
    call(index, [&](Worker& w) {
      w.node->stage->finish(*w.out, *w.context);
      refuse_overwritten(index);
    });
    for (const auto& edge : workers_[index].edges) {
      Worker& fed = workers_[edge.to];
      if (--fed.open[edge.input] == 0 && is_ready(fed)) replay(edge.to);
    }
  }

  /// Stages declare the files that they write, and are checked before the run; this is for those that do not.
  void refuse_overwritten(std::size_t index) const {
    const auto& own = workers_[index].result.report.written;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      const auto& theirs = workers_[i].result.report.written;
      const auto same = std::ranges::find_first_of(own, theirs);
      if (i == index || same == own.end()) continue;
      throw Error("it has overwritten " + same->string() + ", which " + workers_[i].result.tag + " wrote",
                  "let it write another file");
    }
  }

  static Error never_came(const Worker& worker) {
    std::string missing;
    for (std::size_t i = 0; i < worker.slots.size(); ++i) {
      const StageInput& input = worker.node->type->inputs[i];
      if (input.held && input.required && !worker.slots[i].value) missing = input.kind.name();
    }
    return Error(worker.node->tag + ": it waited for a " + missing + ", but the stages above gave none",
                 "see what they report", worker.node->place);
  }

  void give(std::size_t from, const Item& item) {
    const bool waits_its_turn = together_ && workers_[from].node->type->endless;
    const auto turn = waits_its_turn ? std::unique_lock(turn_) : std::unique_lock<std::mutex>();
    if (is_stopped() || abandoned_) throw Interrupted();
    Worker& worker = workers_[from];
    const auto& outputs = worker.node->type->outputs;
    const auto output = std::find(outputs.begin(), outputs.end(), item.kind);
    if (output == outputs.end()) {
      throw Error("it gives " + std::string(item.kind.name()) + ", which it does not declare",
                  "let the stage's describe() declare it by gives()");
    }
    if (!item.value)
      throw Error("it gives a " + std::string(item.kind.name()) + " that is null",
                  "let the stage give an item, or nothing");
    ++worker.given[static_cast<std::size_t>(output - outputs.begin())];
    if (hooks_.given) hooks_.given(worker.node->tag, item);
    for (const auto& edge : worker.edges) {
      if (edge.kind == item.kind) deliver(edge.to, edge.input, item);
    }
  }

  /// Calls into a stage: measures its time, and adds its tag and place to what it throws.
  template <class Call>
  void call(std::size_t index, Call&& body) {
    if (is_stopped()) throw Interrupted();
    Worker& worker = workers_[index];
    try {
      const bool waits = together_ && worker.node->type->endless;
      if (waits) {  // the stopwatch is for what takes turns
        body(worker);
      } else {
        const Stopwatch::Turn turn(stopwatch_, worker.result.seconds);
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
      const Error error = error_of(thrown);
      throw Reported(worker.node->tag + ": " + error.message(), error.advice(), worker.node->place);
    } catch (...) {
      throw Reported(worker.node->tag + ": it threw something that is no std::exception",
                     "let it throw crisp::Error", worker.node->place);
    }
    announce_caveats(worker);
    if (is_stopped()) throw Interrupted();
  }

  void announce_caveats(Worker& worker) const {
    const auto& caveats = worker.result.report.caveats;
    if (!hooks_.caveat || worker.announced == caveats.size()) return;
    const std::lock_guard lock(reported_);
    for (; worker.announced < caveats.size(); ++worker.announced)
      hooks_.caveat(worker.node->tag, caveats[worker.announced]);
  }

  ProgressSink progress_of(const Worker& worker) const {
    if (!hooks_.progress) return {};
    return [this, &worker](const Progress& progress) {
      const std::lock_guard lock(reported_);
      hooks_.progress(worker.node->tag, progress);
    };
  }

  StatusSink status_of(const Worker& worker) const {
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
  std::deque<Worker> workers_;
  bool ends_gently_ = false;
  Stopwatch stopwatch_;
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
