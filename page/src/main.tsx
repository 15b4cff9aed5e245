import "uplot/dist/uPlot.min.css";
import "./style.css";
import { createRoot } from "react-dom/client";
import { App } from "./app";
import { keepTheme, keptTheme } from "./state/keeping";
import { update } from "./state/store";

const theme = keptTheme();
keepTheme(theme);
update({ theme });
createRoot(document.getElementById("root")!).render(<App />);
