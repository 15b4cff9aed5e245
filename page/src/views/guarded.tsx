// A view that fails leaves the rest of the page alone, and says how to go on.

import { Component, type ReactNode } from "react";

interface GuardedProps {
  /** Begins the view anew, as with settings that it has by default. */
  reset: () => void;
  children: ReactNode;
}

export class Guarded extends Component<GuardedProps, { problem: string }> {
  override state = { problem: "" };

  static getDerivedStateFromError(problem: unknown): { problem: string } {
    return { problem: problem instanceof Error ? problem.message : String(problem) };
  }

  private readonly again = () => {
    this.props.reset();
    this.setState({ problem: "" });
  };

  override render(): ReactNode {
    if (!this.state.problem) return this.props.children;
    return (
      <p className="banner bad" role="alert">
        This view could not be drawn ({this.state.problem}). The design is not affected. <button type="button" onClick={this.again}>Draw it anew</button>
      </p>
    );
  }
}
