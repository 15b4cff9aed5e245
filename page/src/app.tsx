// The page: header, the machine with its values, and the views.

import { type DragEvent, useEffect, useState } from "react";
import { Chain } from "./parts/chain";
import { attempt } from "./parts/downloads";
import { Fields } from "./parts/fields";
import { MissingFiles } from "./parts/files";
import { Header, listenForKeys } from "./parts/header";
import { Notices, Warnings } from "./parts/notices";
import { begin } from "./state/beginning";
import { beginAsking } from "./state/engine";
import { JOBS } from "./state/jobs";
import { keepWork } from "./state/keeping";
import { openFiles } from "./state/opening";
import { useStore } from "./state/store";
import { Panel } from "./views/panel";

export function App() {
  const ready = useStore((state) => state.start !== null);
  const stopped = useStore((state) => state.stopped);
  useEffect(() => void begin(), []);
  useEffect(() => {
    if (!ready) return undefined;
    JOBS.resume();
    const ends = [beginAsking(), keepWork(), listenForKeys()];
    return () => ends.forEach((end) => end());
  }, [ready]);
  if (!ready) return <p className="note beginning" role={stopped ? "alert" : "status"}>{stopped || "The workbench is starting …"}</p>;
  return <Page />;
}

function Page() {
  const [over, setOver] = useState(false);
  const drop = {
    onDragOver: (event: DragEvent) => {
      event.preventDefault();
      setOver(true);
    },
    onDragLeave: (event: DragEvent) => event.currentTarget === event.target && setOver(false),
    onDrop: (event: DragEvent) => {
      event.preventDefault();
      setOver(false);
      void attempt("Opening", () => openFiles([...event.dataTransfer.files]));
    },
  };
  return (
    <div className={over ? "page over" : "page"} {...drop}>
      <Header />
      <div className="notices">
        <MissingFiles />
        <Notices />
      </div>
      <Chain />
      <aside aria-label="Values of the machine">
        <Warnings />
        <Fields />
      </aside>
      <Panel />
    </div>
  );
}
