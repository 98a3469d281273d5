// SPDX-License-Identifier: Apache-2.0
// Questions to the person, as modal dialogs: the browser keeps the focus inside and gives it back.
import { button, h, type Child } from './dom';

let count = 0;

/** What the form holds once it is submitted; null where the person thought better of it. */
export function ask(title: string, submit: string, ...fields: Child[]): Promise<FormData | null> {
  const id = `question-${++count}`;
  const form = h('form', { method: 'dialog', class: 'question' },
    h('h2', { id }, title), fields,
    h('div', { class: 'row end' },
      button('Cancel', () => dialog.close()),
      h('button', { type: 'submit', class: 'primary', value: 'submit' }, submit)));
  const dialog = h('dialog', { 'aria-labelledby': id, onkeydown: submitByControlEnter }, form);
  return shown(dialog, (value) => (value === 'submit' ? new FormData(form) : null));
}

/** Only to be read. */
export function tell(title: string, ...content: Child[]): Promise<null> {
  const id = `question-${++count}`;
  const dialog = h('dialog', { 'aria-labelledby': id },
    h('form', { method: 'dialog', class: 'question' }, h('h2', { id }, title), content,
      h('div', { class: 'row end' }, h('button', { type: 'submit', autofocus: true }, 'Close'))));
  return shown(dialog, () => null);
}

function shown<T>(dialog: HTMLDialogElement, answer: (value: string) => T): Promise<T> {
  document.body.append(dialog);
  const leave = () => dialog.close();
  addEventListener('hashchange', leave);
  return new Promise((done) => {
    dialog.addEventListener('close', () => {
      removeEventListener('hashchange', leave);
      dialog.remove();
      done(answer(dialog.returnValue));
    });
    dialog.showModal();
  });
}

function submitByControlEnter(event: KeyboardEvent): void {
  if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
  const form = (event.currentTarget as HTMLElement).querySelector('form');
  form?.requestSubmit(form.querySelector<HTMLButtonElement>('button[value=submit]'));
}
