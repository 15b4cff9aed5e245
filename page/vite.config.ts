import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";

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
  // `npm run dev` beside a running `torsional workbench --port 8765`.
  server: { proxy: { "/api": { target: "http://127.0.0.1:8765", changeOrigin: true } } },
});
