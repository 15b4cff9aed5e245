import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";

const SERVER = "http://127.0.0.1:8210";

// No inline script and no inline picture: the server's content policy allows files of its own alone.
export default defineConfig({
  base: "./",
  plugins: [react()],
  build: {
    outDir: "../src/torsional/workbench/page",
    emptyOutDir: true,
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    target: "es2022",
  },
  // `npm run dev` beside a running `torsional workbench --no-browser`; the server answers pages of its own address alone.
  server: { proxy: { "/api": { target: SERVER, changeOrigin: true, headers: { Origin: SERVER } } } },
});
